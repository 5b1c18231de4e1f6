// The steps of `heel preflight` that talk to the robot, through the daemon's own link. Whatever happens, the
// link's end sends STOP and CLOSE.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "core/angles.h"
#include "heel/error.h"
#include "preflight_step.h"
#include "realtime/clock.h"
#include "robot/robot_link.h"
#include "robot/session_event_text.h"

namespace heel::cli {
namespace {

constexpr TimeNs kTick_ns = kNsPerS / 50;
constexpr TimeNs kConnect_ns = 20 * kNsPerS;  // a sweep of all rates takes 9 s
constexpr std::uint64_t kMostOpenFailures = 2;
constexpr TimeNs kListen_ns = 2 * kNsPerS;
constexpr double kLeastSips_1_s = 8.0;  // of ten
constexpr std::size_t kFrontSonars = 8;

constexpr double kForwards_m_s = 0.1;
constexpr double kLeft_rad_s = 0.35;
constexpr TimeNs kExpiry_ns = 250 * kNsPerMs;
constexpr TimeNs kMove_ns = 1500 * kNsPerMs, kRest_ns = kNsPerS;
constexpr double kLeastShare = 0.5;  // of the way that was commanded

/// The daemon's link, ticked as its control thread does.
class TickedLink {
 public:
  explicit TickedLink(const RobotConfig& config) : link_(config) {}
  ~TickedLink() { link_.shutdown(monotonic_now_ns()); }
  TickedLink(const TickedLink&) = delete;
  TickedLink& operator=(const TickedLink&) = delete;

  const RobotState& state() const { return link_.state(); }

  /// Commands this velocity until `done` or for so long; true: done. Ends early when interrupted.
  template <typename Done>
  bool run(double v_m_s, double yaw_rate_rad_s, TimeNs longest_ns, const Done& done) {
    VelocityCommand command;
    command.v_m_s = v_m_s;
    command.yaw_rate_rad_s = yaw_rate_rad_s;
    const TimeNs end_ns = monotonic_now_ns() + longest_ns;
    for (TimeNs next_ns = monotonic_now_ns(); next_ns < end_ns && !g_preflight_interrupted;) {
      next_ns += kTick_ns;
      link_.receive_until(next_ns);
      const TimeNs now_ns = monotonic_now_ns();
      link_.read(now_ns);
      command.t_issued_ns = now_ns;
      command.t_expires_ns = now_ns + kExpiry_ns;
      link_.write(command, now_ns);
      note_events();
      if (done()) return true;
    }
    return false;
  }

  bool connect() {
    return run(0.0, 0.0, kConnect_ns,
               [&] {
                 return state().phase == LinkPhase::Running || state().phase == LinkPhase::Disabled ||
                        state().phase == LinkPhase::Refused || link_.open_failures() > kMostOpenFailures;
               }) &&
           link_.open_failures() <= kMostOpenFailures;
  }

  /// What the robot, or the lack of one, has said last.
  std::string last_note() const {
    return link_.open_failures() > 0 && note_.empty() ? link_.last_open_error() : note_;
  }
  const std::string& kind() const { return kind_; }

 private:
  void note_events() {
    SessionEvent event;
    while (link_.next_event(event)) {
      std::array<char, 400> text{};
      write_event_text(event, state().kind, link_.heard_text(), text);
      std::string line = text.data();
      if (const std::size_t place = line.find("{}"); place != std::string::npos)
        line.replace(place, 2, std::to_string(event.value));
      if (event.kind == SessionEventKind::Synchronised) kind_ = line.substr(line.find(": ") + 2);
      if (is_warning(event.kind)) note_ = line;
    }
  }

  RobotLink link_;
  std::string note_, kind_;
};

constexpr const char* kNoRobot = "check robot.address, the cable, and that the robot is switched on";

/// Fails where the robot is not ready to drive.
bool require_running(TickedLink& link, const Config& config, PreflightStep& step) {
  const bool answered = link.connect();
  const std::string note = link.last_note();
  if (!answered) {
    step.fail(note.empty() ? config.robot.address + ": robot does not answer" : note,
              advice_on(note, kNoRobot));
    return false;
  }
  if (link.state().phase == LinkPhase::Refused) {
    step.fail(note, "docs/hardware.md lists the robots that heel knows");
    return false;
  }
  if (link.state().phase == LinkPhase::Disabled) {
    step.fail(note, "release the stop button and charge the battery");
    return false;
  }
  return true;
}

}  // namespace

PreflightStep check_robot(const Config& config) {
  PreflightStep step{.name = "robot"};
  try {
    TickedLink link(config.robot);
    if (!require_running(link, config, step)) return step;
    const std::uint64_t before = link.state().sips;
    link.run(0.0, 0.0, kListen_ns, [] { return false; });
    const RobotState& state = link.state();
    const double sips_1_s = static_cast<double>(state.sips - before) / seconds_from_ns(kListen_ns);
    std::size_t heard = 0;
    for (std::size_t i = 0; i < kFrontSonars; ++i) heard += state.sonar[i].t_ns != 0;
    step.values = {{"robot", link.kind()},
                   {"battery_v", state.battery_v},
                   {"packets_1_s", sips_1_s},
                   {"front_sonars_heard", heard},
                   {"checksum_errors", state.checksum_errors}};
    const std::string measured =
        fmt::format("{}; battery {:.1f} V, {:.0f} packets/s, {} of {} front sonars heard", link.kind(),
                    state.battery_v, sips_1_s, heard, kFrontSonars);
    if (state.battery_v < config.supervisor.battery_ok_v)
      return step.fail(measured, fmt::format("charge the battery (expected {:g} V, supervisor.battery_ok_v)",
                                             config.supervisor.battery_ok_v));
    if (sips_1_s < kLeastSips_1_s)
      return step.fail(measured, "check the cable and its length (expected 10 packets/s)");
    if (state.bumpers_front != 0 || state.bumpers_rear != 0)
      return step.fail(measured + ", a bumper is pressed", "free the bumper");
    if (config.robot.sonar && heard < kFrontSonars)
      return step.fail(measured,
                       "check the sonars' cable, or set robot.sonar = false: the robot then sees no "
                       "obstacle");
    return step.pass(measured);
  } catch (const Error& error) {
    return step.fail(error.what(), kNoRobot);
  }
}

PreflightStep check_wheels(const Config& config) {
  PreflightStep step{.name = "wheels"};
  try {
    TickedLink link(config.robot);
    if (!require_running(link, config, step)) return step;
    const auto never = [] { return false; };
    const auto drive = [&](double v_m_s, double yaw_rate_rad_s) {
      const Odometry before = link.state().odometry;
      link.run(v_m_s, yaw_rate_rad_s, kMove_ns, never);
      link.run(0.0, 0.0, kRest_ns, never);
      const Odometry& after = link.state().odometry;
      const double dx_m = after.x_m - before.x_m, dy_m = after.y_m - before.y_m;
      return std::pair(dx_m * std::cos(before.heading_rad) + dy_m * std::sin(before.heading_rad),
                       after.heading_rad - before.heading_rad);
    };
    const double forwards_m = drive(kForwards_m_s, 0.0).first;
    const double left_rad = drive(0.0, kLeft_rad_s).second;
    const double move_s = seconds_from_ns(kMove_ns);
    const std::string measured = fmt::format(
        "commanded {:.2f} m forwards and {:.0f}° to the left: {:.2f} m and {:.0f}°", kForwards_m_s * move_s,
        kLeft_rad_s * move_s * kDegPerRad, forwards_m, left_rad * kDegPerRad);
    step.values = {{"forwards_m", forwards_m}, {"left_rad", left_rad}};
    if (g_preflight_interrupted) return step.fail(measured, "interrupted: the robot has been stopped");
    if (forwards_m < kLeastShare * kForwards_m_s * move_s)
      return step.fail(measured,
                       "the wheels do not turn forwards as odometry counts: check their connectors "
                       "and encoders");
    if (left_rad < kLeastShare * kLeft_rad_s * move_s)
      return step.fail(measured,
                       "the robot does not turn to the left as odometry counts: are the wheels of "
                       "left and right exchanged?");
    return step.pass(measured + "; did the wheels turn so?");
  } catch (const Error& error) {
    return step.fail(error.what(), kNoRobot);
  }
}

}  // namespace heel::cli
