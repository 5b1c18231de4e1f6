// Figures 7 and 8: the robot's paths.
#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

#include "core/angles.h"
#include "evaluation/reports/paper_figures.h"
#include "evaluation/reports/plot.h"
#include "evaluation/reports/style.h"

namespace heel::evaluation {
namespace {

const cv::Scalar kPositionOnly = kGreen;
constexpr int kRunWidth_px = 900, kRunPathHeight_px = 330, kRunPanelHeight_px = 230, kWalkHeight_px = 640;

Series robot_path(const MetricsCollector& run, const char* name, const cv::Scalar& bgr) {
  Series path{name, bgr, {}, 2.0, false};
  for (const MotionSample& sample : run.motion())
    path.points.emplace_back(sample.robot.x_m, sample.robot.y_m);
  return path;
}

Series person_path(const MetricsCollector& run) {
  Series path{"person", kPerson, {}, 2.0, false};
  for (const MotionSample& sample : run.motion())
    if (sample.has_person) path.points.emplace_back(sample.person.x_m, sample.person.y_m);
  return path;
}

std::string titled(const char* format, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b);
  return text;
}

}  // namespace

cv::Mat response_figure(const MetricsCollector& run) {
  Series offset{"robot's distance from the person's line", kRobot, {}, 1.8, false};
  Series heading{"robot's heading against the person's", kPerson, {}, 1.8, false};
  double gone_m = 0.0;
  for (std::size_t i = 0; i < run.motion().size(); ++i) {
    const MotionSample& now = run.motion()[i];
    if (i > 0) {
      const PathPoint& before = run.motion()[i - 1].robot;
      gone_m += std::hypot(now.robot.x_m - before.x_m, now.robot.y_m - before.y_m);
    }
    // The person walks straight on: their line is where they are and where they face.
    const double c = std::cos(now.person.heading_rad), s = std::sin(now.person.heading_rad);
    offset.points.emplace_back(gone_m,
                               -s * (now.robot.x_m - now.person.x_m) + c * (now.robot.y_m - now.person.y_m));
    heading.points.emplace_back(gone_m,
                                kDeg * wrap_angle_rad(now.robot.heading_rad - now.person.heading_rad));
  }
  const Span x{0.0, gone_m};
  const Series zero{"", kGrey, {{0.0, 0.0}, {gone_m, 0.0}}, 1.0, false};
  const auto begin = offset.points.empty() ? cv::Point2d() : offset.points.front();
  const auto turned = heading.points.empty() ? cv::Point2d() : heading.points.front();
  const std::vector<cv::Mat> panels{
      plot({titled("Figure 7: set down %.2f m beside the line, turned by %.0f degrees", begin.y, turned.y),
            "x in m",
            "y in m",
            true,
            false,
            {}},
           {person_path(run), robot_path(run, "robot", kRobot)}, kRunWidth_px, kRunPathHeight_px),
      plot({"", "way driven in m", "offset in m", false, false, x}, {zero, offset}, kRunWidth_px,
           kRunPanelHeight_px),
      plot({"", "way driven in m", "degrees", false, false, x}, {zero, heading}, kRunWidth_px,
           kRunPanelHeight_px)};
  cv::Mat out;
  cv::vconcat(panels, out);
  return out;
}

cv::Mat walk_figure(const MetricsCollector& run, const MetricsCollector* position_only) {
  const FollowMetrics metrics = run.evaluate();
  std::vector<Series> series;
  std::string title = titled("Figure 8: %.0f m walked, the robot's path %.2f m RMS beside",
                             metrics.person_path_m, metrics.lateral_m.rms);
  if (position_only != nullptr) {
    series.push_back(robot_path(*position_only, "robot that follows the position only", kPositionOnly));
    title += titled(" (position only: %.2f m)", position_only->evaluate().lateral_m.rms, 0.0);
  }
  series.push_back(person_path(run));
  series.push_back(robot_path(run, "robot", kRobot));
  return plot({title, "x in m", "y in m", true, false, {}}, series, kRunWidth_px, kWalkHeight_px);
}

}  // namespace heel::evaluation
