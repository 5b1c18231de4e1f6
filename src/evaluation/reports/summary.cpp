#include "evaluation/reports/summary.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace heel::evaluation {
namespace {

double degrees(double rad) {
  return rad * 180.0 / M_PI;
}

/// Lines of a name and a value.
class Lines {
 public:
  [[gnu::format(printf, 3, 4)]] void add(const char* name, const char* format, ...) {
    char value[200];
    va_list values;
    va_start(values, format);
    std::vsnprintf(value, sizeof value, format, values);
    va_end(values);
    char line[240];
    std::snprintf(line, sizeof line, "%-22s %s\n", name, value);
    text_ += line;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void add_stops(const FollowMetrics& m, Lines& lines) {
  if (m.rest_s_by_reason.empty()) lines.add("stops", "none");
  for (const auto& [reason, rest_s] : m.rest_s_by_reason) {
    const auto times = m.stops_by_reason.find(reason);
    const int count = times == m.stops_by_reason.end() ? 0 : times->second;
    lines.add("stops", "%d: %s, %.2f s at rest", count, reason.c_str(), rest_s);
  }
}

}  // namespace

std::string summary_text(const FollowMetrics& m, const std::vector<std::string>& failed) {
  Lines lines;
  lines.add("person walked", "%.2f m in %.1f s", m.person_path_m, m.t_walk_end_s - m.t_walk_begin_s);
  lines.add("robot drove", "%.2f m", m.robot_path_m);
  if (m.lateral_m.count > 0)
    lines.add("beside the path", "%.3f m RMS, %.3f m at most", m.lateral_m.rms,
              std::max(std::abs(m.lateral_m.lowest), std::abs(m.lateral_m.highest)));
  if (m.separation_m.count > 0)
    lines.add("behind the person", "%.2f m mean, %.2f to %.2f m", m.separation_m.mean, m.separation_m.lowest,
              m.separation_m.highest);
  lines.add("target found", "in %llu of %llu frames", static_cast<unsigned long long>(m.frames_found),
            static_cast<unsigned long long>(m.frames));
  lines.add("out of view", "%.2f s at the longest", m.out_of_view_longest_s);
  if (m.certainty.count > 0)
    lines.add("certainty", "%.2f median, 90 %% of frames between %.2f and %.2f", m.certainty.p50,
              m.certainty.p05, m.certainty.p95);
  if (m.yaw_error_rad.count > 0) {
    lines.add("yaw error", "%.2f degrees RMS, mean %+.2f", degrees(m.yaw_error_rad.rms),
              degrees(m.yaw_error_rad.mean));
    lines.add("position error", "%.0f mm sideways, %.0f mm in height, %.0f mm in distance (RMS)",
              1e3 * m.x_error_m.rms, 1e3 * m.y_error_m.rms, 1e3 * m.z_error_m.rms);
  }
  add_stops(m, lines);
  for (const std::string& reason : failed) lines.add("FAILED", "%s", reason.c_str());
  return lines.text();
}

}  // namespace heel::evaluation
