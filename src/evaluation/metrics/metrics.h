// How well the robot followed in a run: its path relative to the person's, how long the shirt was not found,
// the errors of the estimates. Computed from samples, which come from lock step or from the CSV files of a
// finished run.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/metrics/following_figures.h"
#include "evaluation/metrics/samples.h"

namespace heel::evaluation {

/// A target that is found farther than this from its true place is a wrong one.
inline constexpr double kWrong_m = 0.5;

struct FollowMetrics {
  double t_walk_begin_s = 0.0, t_walk_end_s = 0.0;  ///< while the person walked
  double person_path_m = 0.0, robot_path_m = 0.0;
  Quantiles lateral_m;            ///< the robot's distance from the person's path, positive to the left of it
  Quantiles separation_m;         ///< robot to person
  double separation_end_m = 0.0;  ///< at the end of the walk
  std::uint64_t frames = 0, frames_found = 0;
  std::uint64_t frames_wrong = 0;      ///< found, but more than kWrong_m from the true place
  double out_of_view_longest_s = 0.0;  ///< longest time between two frames in which the target was found
  double out_of_view_total_s = 0.0;    ///< frames not found, times the frame period
  double truly_out_of_view_longest_s = 0.0;  ///< by geometry
  Quantiles certainty, yaw_error_rad, x_error_m, y_error_m, z_error_m;
  double yaw_nees = 0.0;    ///< mean of (error/sigma)²: 1 when the stated sigma is right
  double touching_s = 0.0;  ///< with a bumper pressed
  std::map<std::string, double> rest_s_by_reason;  ///< while the person walked
  std::map<std::string, int> stops_by_reason;      ///< number of stops while the person walked
  FollowingFigures following;
};

class MetricsCollector {
 public:
  explicit MetricsCollector(const FollowReference& reference = {}) : reference_(reference) {}

  void add(const MotionSample& sample) { motion_.push_back(sample); }
  void add(const PoseSample& sample) { poses_.push_back(sample); }
  void add(const TickSample& sample) { ticks_.push_back(sample); }

  const std::vector<MotionSample>& motion() const { return motion_; }
  const std::vector<PoseSample>& poses() const { return poses_; }
  const std::vector<TickSample>& ticks() const { return ticks_; }

  FollowMetrics evaluate() const;

 private:
  FollowReference reference_;
  std::vector<MotionSample> motion_;
  std::vector<PoseSample> poses_;
  std::vector<TickSample> ticks_;
};

nlohmann::ordered_json to_json(const FollowMetrics& metrics);

/// Limits for a run; negative: no limit.
struct FollowCriteria {
  double max_out_of_view_s = -1.0;
  double max_rms_m = -1.0;
  double min_robot_path_m = -1.0;
};
/// One line for each criterion that is not met.
std::vector<std::string> failed_criteria(const FollowMetrics& metrics, const FollowCriteria& criteria);

}  // namespace heel::evaluation
