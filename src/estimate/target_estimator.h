// Estimates the person's pose in the odometry frame. A frame's measurement is placed by the robot's pose at
// its capture time. Two constant-velocity filters, of the back's position and yaw, smooth and predict; a
// third filter separates the direction of travel from the swing of the back.
#pragma once

#include "core/config.h"
#include "estimate/constant_velocity_filter.h"
#include "estimate/odometry_history.h"
#include "estimate/target_measurement.h"
#include "estimate/travel_filter.h"
#include "heel/flow.h"

namespace heel {

/// Reads no clock and does not allocate.
class TargetEstimator {
 public:
  explicit TargetEstimator(const Config& config) { reconfigure(config); }

  /// New thresholds and set points; the estimate is kept.
  void reconfigure(const Config& config);
  /// Forgets the person and the robot's path.
  void reset();

  void add_odometry(const Odometry& odometry);
  /// Of the packets so far.
  const OdometryHistory& odometry() const { return odometry_; }
  /// Accepted, or the gate that the pose did not pass; never None.
  MeasurementStatus update(const PoseEstimate& pose);
  /// The person, and the pose that the robot is to take, in the robot frame at `now_ns`.
  TargetState predict(TimeNs now_ns) const;

 private:
  void start(const BackMeasurement& back);

  CameraMount mount_;
  EstimateConfig settings_;
  struct SetPoints {
    double t_z_m = 0.0, t_x_m = 0.0, yaw_rad = 0.0;
  };
  SetPoints set_points_;

  OdometryHistory odometry_;
  ConstantVelocityFilter<2> position_;  // odom, m
  ConstantVelocityFilter<1> yaw_;       // odom, rad, continuous
  TravelFilter travel_;                 // odom
  bool known_ = false;
  TimeNs t_capture_ns_ = 0;
  double certainty_ = 0.0;
  Eigen::Vector2d in_reference_view_m_ = Eigen::Vector2d::Zero();
  int outliers_in_a_row_ = 0;
};

}  // namespace heel
