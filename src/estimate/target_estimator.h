// The person in the odometry frame. Frames are placed where the robot was when they were taken; two
// constant-velocity filters carry position and walking direction from frame to frame and on to `now`.
#pragma once

#include "core/config.h"
#include "estimate/constant_velocity_filter.h"
#include "estimate/odometry_history.h"
#include "estimate/target_measurement.h"
#include "heel/flow.h"

namespace heel {

/// Reads no clock and does not allocate.
class TargetEstimator {
 public:
  explicit TargetEstimator(const Config& config) { reconfigure(config); }

  /// New thresholds and set points; what is known of the person is kept.
  void reconfigure(const Config& config);
  /// Forgets the person and the path: odom has begun anew.
  void reset();

  void add_odometry(const Odometry& odometry);
  /// True when the frame was believed: found, metric, newer than the last, placed in odom, not a wild jump.
  bool update(const PoseEstimate& pose);
  /// The person and the pose to take, in the robot frame at `now_ns`.
  TargetState at(TimeNs now_ns) const;

 private:
  void start(const Eigen::Vector2d& position_odom_m, double yaw_odom_rad, const Eigen::Matrix2d& R_position,
             double yaw_variance);

  CameraMount mount_;
  EstimateConfig settings_;
  struct SetPoints {
    double t_z_m = 0.0, t_x_m = 0.0, yaw_rad = 0.0;
  };
  SetPoints set_points_;

  OdometryHistory path_;
  ConstantVelocityFilter<2> position_;  // odom, m
  ConstantVelocityFilter<1> yaw_;       // odom, rad, continuous
  bool known_ = false;
  TimeNs t_capture_ns_ = 0;
  double certainty_ = 0.0;
  Eigen::Vector2d in_reference_view_m_ = Eigen::Vector2d::Zero();
  int outliers_in_a_row_ = 0;
};

}  // namespace heel
