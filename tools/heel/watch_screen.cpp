#include "watch_screen.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "status_fields.h"

namespace heel::cli {
namespace {

constexpr double kDegrees = 57.29577951308232;
constexpr int kBarWidth = 24;
/// Status comes several times a second: after so long without, what is shown is old.
constexpr double kOld_s = 1.5;
constexpr std::string_view kPlain = "\x1b[0m", kBold = "\x1b[1m", kDim = "\x1b[2m";
constexpr std::string_view kGreen = "\x1b[30;42m", kYellow = "\x1b[30;43m", kRed = "\x1b[97;41m",
                           kGrey = "\x1b[30;47m";

class Lines {
 public:
  explicit Lines(const WatchLook& look) : look_(look) {}

  std::vector<std::string> take() { return std::move(lines_); }
  void add(std::string_view style, const std::string& text) { lines_.push_back(styled(style, text)); }
  void row(std::string_view name, const std::string& text) {
    lines_.push_back(styled(kDim, fmt::format(" {:<10}", name)) + cut(text, look_.columns - 12));
  }
  std::string styled(std::string_view style, const std::string& text) const {
    if (!look_.colour || style.empty()) return text;
    return std::string(style) + text + std::string(kPlain);
  }
  /// Broken between words.
  void wrapped(std::string_view style, std::string_view text) {
    const std::size_t width = static_cast<std::size_t>(std::max(20, look_.columns - 2));
    while (!text.empty()) {
      std::size_t end = std::min(width, text.size());
      if (end < text.size())
        if (const std::size_t space = text.rfind(' ', end); space != std::string_view::npos && space > 0)
          end = space;
      add(style, " " + std::string(text.substr(0, end)));
      text.remove_prefix(std::min(text.size(), end + (end < text.size() && text[end] == ' ' ? 1 : 0)));
    }
  }

 private:
  static std::string cut(const std::string& text, int columns) {
    return text.substr(0, static_cast<std::size_t>(std::max(0, columns)));
  }

  const WatchLook& look_;
  std::vector<std::string> lines_;
};

std::string_view colour_of(const std::string& state) {
  if (state == "following") return kGreen;
  if (state == "searching" || state == "waiting") return kYellow;
  if (state == "stopped" || state == "emergency") return kRed;
  return kGrey;
}

/// "0.48 m/s  [###########             ]  of 0.70 m/s".
std::string bar(double share) {
  const int filled = static_cast<int>(std::lround(std::clamp(std::abs(share), 0.0, 1.0) * kBarWidth));
  return "[" + std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(kBarWidth - filled), ' ') + "]";
}

std::string speed_text(const Json& status) {
  const Json& limits = part(status, "limits");
  const std::optional<double> v_m_s = status_number(part(status, "robot"), "v_m_s");
  const std::optional<double> most_m_s = status_number(limits, "gate.v_max_m_s");
  if (!v_m_s) return "unknown";
  std::string out = fmt::format("{:5.2f} m/s ", *v_m_s);
  if (most_m_s && *most_m_s > 0.0) out += fmt::format(" {} of {:.2f}", bar(*v_m_s / *most_m_s), *most_m_s);
  return out + fmt::format(", commanded {}", number(part(status, "command"), "v_m_s", "{:.2f}"));
}

std::string side(double angle_rad) {
  const double angle_deg = angle_rad * kDegrees;
  if (std::abs(angle_deg) < 0.5) return "straight ahead";
  return fmt::format("{:.0f} deg {}", std::abs(angle_deg), angle_deg > 0 ? "left" : "right");
}

std::string person_text(const Json& target) {
  if (!flag(target, "known")) return "not known";
  std::string out = fmt::format("{} away", number(target, "distance_m", "{:.2f} m"));
  const std::optional<double> x_m = status_number(target, "x_m"), y_m = status_number(target, "y_m");
  if (x_m && y_m) out += ", " + side(std::atan2(*y_m, *x_m));
  if (const std::optional<double> travel_rad = status_number(target, "travel_yaw_rad"))
    out += ", walks " + side(*travel_rad);
  return out;
}

std::string shirt_text(const Json& target) {
  if (!flag(target, "found")) return fmt::format("not found ({})", text(target, "reason"));
  const std::optional<double> certainty = status_number(target, "certainty");
  return certainty ? fmt::format("{:5.2f}      {} certainty", *certainty, bar(*certainty)) : "found";
}

std::string robot_text(const Json& robot) {
  std::string out = fmt::format("battery {}, link {}, motors {}", number(robot, "battery_v", "{:.1f} V"),
                                text(robot, "link"), flag(robot, "motors") ? "on" : "off");
  if (flag(robot, "stop_button")) out += ", STOP BUTTON PRESSED";
  if (flag(robot, "bumpers")) out += ", BUMPER PRESSED";
  if (flag(robot, "stall")) out += ", WHEELS STALLED";
  return out;
}

}  // namespace

std::vector<std::string> watch_screen(const Json& status, const WatchLook& look) {
  Lines lines(look);
  std::string state = text(status, "state");
  const std::string_view colour = colour_of(state);
  std::transform(state.begin(), state.end(), state.begin(), [](unsigned char c) { return std::toupper(c); });
  const bool old = look.news_age_s > kOld_s;
  lines.add("", "");
  lines.add(old ? kRed : colour,
            old ? fmt::format("  NO NEWS FOR {:.0f} s: what is below is old  ", look.news_age_s)
                : "  " + state + "  ");
  lines.add("", "");
  lines.wrapped(kBold, text(status, "sentence"));
  lines.add(kDim, fmt::format(" for {}, after: {}", number(status, "in_state_s", "{:.0f} s"),
                              text(status, "cause")));
  lines.add("", "");
  const Json& robot = part(status, "robot");
  const Json& camera = part(status, "camera");
  const Json& command = part(status, "command");
  lines.row("speed", speed_text(status));
  if (const std::optional<double> turn_rad_s = status_number(robot, "yaw_rate_rad_s"))
    lines.row("turn", fmt::format("{:5.0f} deg/s", *turn_rad_s * kDegrees));
  lines.row("person", person_text(part(status, "target")));
  lines.row("shirt", shirt_text(part(status, "target")));
  lines.row("free", status_number(command, "free_distance_m")
                        ? number(command, "free_distance_m", "{:.2f} m to the nearest echo ahead")
                        : "no echo ahead");
  lines.row("robot", robot_text(robot));
  lines.row("camera",
            fmt::format("frame in use {} old, {} dropped", number(camera, "frame_age_s", "{:.2f} s"),
                        number(camera, "dropped", "{:.0f}")));
  if (const auto set = status.find("set"); set != status.end() && set->is_array()) {
    for (const Json& change : *set)
      lines.row("not saved", fmt::format("{} {} -> {}", text(change, "key"), text(change, "before"),
                                         text(change, "after")));
  }
  lines.add("", "");
  lines.wrapped(look.note.empty() ? kDim : kBold,
                look.note.empty() ? "space: emergency stop    q: quit" : std::string_view(look.note));
  return lines.take();
}

}  // namespace heel::cli
