// The samples of a run that figures are computed from, and what all figures use: quantiles, the person's
// path.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/pose2.h"

namespace heel::evaluation {

/// One row of the truth.
struct MotionSample {
  double t_s = 0.0;
  Pose2 robot;
  bool has_person = false;
  Pose2 person;
  double person_speed_m_s = 0.0;
  bool back_in_view = false;  ///< by geometry, independent of vision; false when something hides it
  bool back_hidden = false;   ///< an obstacle or a person is in front of it
  bool has_back = false;      ///< the next three are known
  double back_x_m = 0.0, back_y_m = 0.0;  ///< middle of the back
  double back_yaw_rad = 0.0;              ///< against the camera, as PoseEstimate::yaw_rad
  bool touching = false;                  ///< a bumper is pressed
  double robot_v_m_s = 0.0, robot_yaw_rate_rad_s = 0.0;
};

/// One frame: vision's estimate and the truth.
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
  std::string stop_reason;  ///< "following", or why the robot does not follow
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

nlohmann::ordered_json to_json(const Quantiles& quantiles);
/// The times of the first and the last step; of all samples when the person does not walk.
struct WalkTimes {
  double begin_s = 0.0, end_s = 0.0;
};
WalkTimes walk_times(const std::vector<MotionSample>& motion);
/// Where the person walked, at least a centimetre between two points: a person who stands adds nothing.
std::vector<Pose2> person_path(const std::vector<MotionSample>& motion);

/// A point beside a walked path.
struct PathPlace {
  double lateral_m = 0.0;   ///< positive to the left of the path
  std::size_t segment = 0;  ///< between this point of the path and the next
  double share = 0.0;       ///< of that segment; negative: before the path's first point
};
/// The path is extended backwards in a straight line. The search begins near point `near` of the path,
/// because a path may cross itself.
PathPlace place_on_path(const std::vector<Pose2>& path, const Pose2& point, std::size_t near);

}  // namespace heel::evaluation
