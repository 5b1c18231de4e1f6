// How well a run followed: the robot's path against the person's, what the camera lost, how far estimates
// were from the truth. Gathered sample by sample, from lock step or from a finished run's CSV files alike.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace heel::evaluation {

struct PathPoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
};

/// One row of truth.
struct MotionSample {
  double t_s = 0.0;
  PathPoint robot;
  bool has_person = false;
  PathPoint person;
  double person_speed_m_s = 0.0;
  bool back_in_view = false;  ///< by geometry, whatever vision made of it
  bool touching = false;      ///< a bumper is pressed
};

/// One frame as vision saw it, and as it truly was.
struct PoseSample {
  double t_s = 0.0;  ///< of capture
  bool found = false;
  std::string reason;
  double certainty = 0.0;
  double yaw_rad = 0.0;
  double yaw_sigma_rad = 0.0;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;  ///< middle of the template, camera frame
  bool has_truth = false;
  double true_yaw_rad = 0.0;
  double true_x_m = 0.0, true_y_m = 0.0, true_z_m = 0.0;
};

struct TickSample {
  double t_s = 0.0;
  std::string stop_reason;  ///< "following" or why not
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

struct Quantiles {
  std::size_t count = 0;
  double mean = 0.0, deviation = 0.0, rms = 0.0;
  double p05 = 0.0, p50 = 0.0, p95 = 0.0, lowest = 0.0, highest = 0.0;
};
Quantiles quantiles(std::vector<double> values);
/// The value of the nearest rank below which `share` of the values lie; 0 when there are none.
double quantile(std::vector<double> values, double share);

/// A target found farther than this from its true place is another one.
inline constexpr double kWrong_m = 0.5;

struct FollowMetrics {
  double t_walk_begin_s = 0.0, t_walk_end_s = 0.0;  ///< while the person walked
  double person_path_m = 0.0, robot_path_m = 0.0;
  Quantiles lateral_m;            ///< robot's distance from the person's path, signed, left of it positive
  Quantiles separation_m;         ///< robot to person
  double separation_end_m = 0.0;  ///< when the walk ends
  std::uint64_t frames = 0, frames_found = 0;
  std::uint64_t frames_wrong = 0;      ///< found, but over kWrong_m from where the target was: something else
  double out_of_view_longest_s = 0.0;  ///< between two frames in which the target was found
  double out_of_view_total_s = 0.0;    ///< frames not found, times the frame period
  double truly_out_of_view_longest_s = 0.0;  ///< by geometry
  Quantiles certainty, yaw_error_rad, x_error_m, y_error_m, z_error_m;
  double yaw_nees = 0.0;    ///< mean of (error/sigma)²: 1 when the stated sigma is honest
  double touching_s = 0.0;  ///< with a bumper pressed
  std::map<std::string, double> rest_s_by_reason;  ///< while the person walked
  std::map<std::string, int> stops_by_reason;  ///< changes from following to rest, while the person walked
};

class MetricsCollector {
 public:
  void add(const MotionSample& sample) { motion_.push_back(sample); }
  void add(const PoseSample& sample) { poses_.push_back(sample); }
  void add(const TickSample& sample) { ticks_.push_back(sample); }

  const std::vector<MotionSample>& motion() const { return motion_; }
  const std::vector<PoseSample>& poses() const { return poses_; }
  const std::vector<TickSample>& ticks() const { return ticks_; }

  FollowMetrics evaluate() const;

 private:
  std::vector<MotionSample> motion_;
  std::vector<PoseSample> poses_;
  std::vector<TickSample> ticks_;
};

/// Signed distance of a point from the walked path, left of it positive; before its first point the path goes
/// on straight backwards. `near` is where the search begins and is moved along: paths may cross themselves.
double lateral_distance_m(const std::vector<PathPoint>& path, const PathPoint& point, std::size_t& near);

nlohmann::ordered_json to_json(const FollowMetrics& metrics);

/// What a run must not exceed; negative: not asked.
struct FollowCriteria {
  double max_out_of_view_s = -1.0;
  double max_rms_m = -1.0;
  double min_robot_path_m = -1.0;
};
/// One line for each that is not met.
std::vector<std::string> failed_criteria(const FollowMetrics& metrics, const FollowCriteria& criteria);

}  // namespace heel::evaluation
