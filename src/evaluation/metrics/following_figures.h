// How closely and how smoothly the robot followed: beside the person's path, along it, jerk, view, contacts.
#pragma once

#include <numbers>
#include <vector>

#include "evaluation/metrics/samples.h"

namespace heel::evaluation {

/// What the run was to keep. Without it the figures that need it have no samples.
struct FollowReference {
  double set_distance_m = 0.0;  ///< robot's centre to the back, along the path; 0: not known
  double camera_x_m = 0.0;      ///< mount of the camera, robot frame
  double camera_y_m = 0.0;
  double separation_m = 0.0;  ///< gate.separation_m, camera to back
};

/// Of the time in which the person walks, from the first step to the last.
struct FollowingFigures {
  double path_p95_m = 0.0;  ///< distance from the person's path: 95 % of the samples are below it
  double path_max_m = 0.0;
  Quantiles along_error_m;          ///< distance to the back along the path, minus the set distance
  double along_p95_m = 0.0;         ///< of its absolute value
  double along_within_share = 0.0;  ///< of the samples within kAlongBand_m
  double along_end_m = 0.0;         ///< the error at the last step
  int separation_entries = 0;       ///< how often the back came nearer to the camera than gate.separation_m
  double jerk_p99_m_s3 = 0.0;       ///< of the commanded speed: second difference over two ticks
  double straight_s = 0.0;          ///< time on straight parts: from 1 m behind the robot to the person
  double straight_yaw_rate_rms_rad_s = 0.0;  ///< of the commands there
  double yaw_within_share = 0.0;             ///< time in which the shirt's yaw is within kYawBand_rad
  double out_of_sight_share =
      0.0;  ///< time in which the back is out of the picture or turned away, not hidden
  Quantiles
      found_again_s;  ///< from the back in view again, after kHidden_s without, to the first frame found
  /// Of a robot that begins at least kStep_m beside the path: from its first motion until it stays within
  /// kSettled_m and kSettled_rad of the path, and the largest offset to the other side over the first one.
  bool has_step = false;
  double settled_s = 0.0;
  double settled_walking_s = 0.0;  ///< the same, from the person's first step if that is later
  double overshoot_share = 0.0;
  int contacts = 0;              ///< how often a bumper was pressed
  int contacts_at_rest = 0;      ///< of them: by somebody who walked into a robot at rest
  double contact_m_s = 0.0;      ///< the largest speed of the robot's bumpers when one was pressed
  bool followed_to_end = false;  ///< at the last step: following, and at most kLeftBehind_m too far behind
};

inline constexpr double kAlongBand_m = 0.15;
inline constexpr double kYawBand_rad = 0.25 * std::numbers::pi;
inline constexpr double kStep_m = 0.2;
inline constexpr double kSettled_m = 0.05;
inline constexpr double kSettled_rad = std::numbers::pi / 36.0;
inline constexpr double kHidden_s = 0.4;
inline constexpr double kAtRest_m_s = 0.01;
inline constexpr double kLeftBehind_m = 1.0;

FollowingFigures following_figures(const std::vector<MotionSample>& motion,
                                   const std::vector<PoseSample>& poses, const std::vector<TickSample>& ticks,
                                   const FollowReference& reference);

nlohmann::ordered_json to_json(const FollowingFigures& figures);

}  // namespace heel::evaluation
