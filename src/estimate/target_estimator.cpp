#include "estimate/target_estimator.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"

namespace heel {
namespace {

// Standard deviations of a new target's velocity.
constexpr double kStartSpeedSigma_m_s = 1.0;
constexpr double kStartYawRateSigma_rad_s = 0.5;
// A homography measures scale, and so range, to a few per cent, and direction much better.
constexpr double kRangeSigmaPerM = 0.02;
constexpr double kAcrossSigmaPerM = 0.005;
// For the travel filter, which has states for the sway that estimate.position_sigma_m allows for.
constexpr double kSwayingPositionSigma_m = 0.01;
// After a longer gap the filters start again from the measurement.
constexpr TimeNs kLongestGap_ns = kNsPerS;
// Longest prediction after the last frame. A person who walks usually walks on; a person who turns soon stops
// turning.
constexpr TimeNs kLongestWalk_ns = 500 * kNsPerMs;
constexpr TimeNs kLongestTurn_ns = 200 * kNsPerMs;

Eigen::Matrix2d rotation(double angle_rad) {
  return Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
}

/// Measurement covariance: long along the line of sight, narrow across it.
Eigen::Matrix2d position_covariance(const Eigen::Vector2d& line_of_sight_odom_m, double floor_sigma_m) {
  const double range_m = line_of_sight_odom_m.norm();
  const double along = std::hypot(floor_sigma_m, kRangeSigmaPerM * range_m);
  const double across = std::hypot(floor_sigma_m, kAcrossSigmaPerM * range_m);
  const Eigen::Matrix2d R = rotation(std::atan2(line_of_sight_odom_m.y(), line_of_sight_odom_m.x()));
  return R * Eigen::Vector2d(along * along, across * across).asDiagonal() * R.transpose();
}

}  // namespace

void TargetEstimator::reconfigure(const Config& config) {
  mount_ = mount_of(config.camera);
  settings_ = config.estimate;
  set_points_ = {config.control.setpoint_t_z_m, config.control.setpoint_t_x_m,
                 config.control.setpoint_yaw_rad};
}

void TargetEstimator::reset() {
  odometry_.clear();
  known_ = false;
  outliers_in_a_row_ = 0;
}

void TargetEstimator::add_odometry(const Odometry& odometry) {
  odometry_.add(odometry);
}

void TargetEstimator::start(const BackMeasurement& back) {
  position_.start(back.position_m, back.R_position, kStartSpeedSigma_m_s);
  yaw_.start(Eigen::Matrix<double, 1, 1>(back.yaw_rad),
             Eigen::Matrix<double, 1, 1>(back.yaw_sigma_rad * back.yaw_sigma_rad), kStartYawRateSigma_rad_s);
  travel_.start(back);
  known_ = true;
  outliers_in_a_row_ = 0;
}

MeasurementStatus TargetEstimator::update(const PoseEstimate& pose) {
  if (!pose.found()) return MeasurementStatus::NotFound;
  const auto measurement = measurement_from_pose(pose, mount_);
  const auto robot = odometry_.pose_at(pose.t_capture_ns);
  const TimeNs gap_ns = pose.t_capture_ns - t_capture_ns_;
  if (!measurement) return MeasurementStatus::Unusable;
  if (!robot) return MeasurementStatus::NoOdometry;
  if (known_ && gap_ns <= 0) return MeasurementStatus::OutOfOrder;

  const Eigen::Vector2d line_of_sight_m = rotation(robot->heading_rad) * measurement->position_m;
  BackMeasurement back;
  back.position_m = Eigen::Vector2d(robot->x_m, robot->y_m) + line_of_sight_m;
  back.R_position = position_covariance(line_of_sight_m, settings_.position_sigma_m);
  back.yaw_rad = robot->heading_rad + measurement->yaw_rad;
  back.yaw_sigma_rad = std::max(measurement->yaw_sigma_rad, settings_.yaw_sigma_rad);
  BackMeasurement swaying = back;
  swaying.R_position = position_covariance(line_of_sight_m, kSwayingPositionSigma_m);

  bool accepted = true;
  if (!known_ || gap_ns > kLongestGap_ns) {
    start(back);
  } else {
    const double gap_s = seconds_from_ns(gap_ns);
    position_.predict(gap_s, settings_.acceleration_m_s2);
    yaw_.predict(gap_s, settings_.yaw_acceleration_rad_s2);
    travel_.predict(gap_s, settings_.acceleration_m_s2);
    const Eigen::Vector2d d_position = back.position_m - position_.position();
    const Eigen::Matrix<double, 1, 1> d_yaw(wrap_angle_rad(back.yaw_rad - yaw_.position()(0)));
    const Eigen::Matrix<double, 1, 1> R_yaw(back.yaw_sigma_rad * back.yaw_sigma_rad);
    const double gate = settings_.outlier_sigma * settings_.outlier_sigma;
    const bool elsewhere = position_.distance_squared(d_position, back.R_position) > gate;
    const bool outlier = elsewhere || yaw_.distance_squared(d_yaw, R_yaw) > gate;
    // The travel filter lowers the weight of a doubtful yaw itself. Without outliers a single frame would
    // change its states for seconds.
    if (!elsewhere) travel_.correct(swaying);
    if (!outlier) {
      position_.correct(d_position, back.R_position);
      yaw_.correct(d_yaw, R_yaw);
      outliers_in_a_row_ = 0;
    } else if (++outliers_in_a_row_ >= settings_.outliers_to_reset) {
      start(back);
    } else {
      accepted = false;
    }
  }
  t_capture_ns_ = pose.t_capture_ns;
  if (!accepted) return MeasurementStatus::Outlier;
  certainty_ = pose.certainty;
  in_reference_view_m_ = measurement->in_reference_view_m;
  return MeasurementStatus::Accepted;
}

TargetState TargetEstimator::predict(TimeNs now_ns) const {
  TargetState target;
  const auto robot = odometry_.pose_at(now_ns);
  if (!known_ || !robot) return target;

  const auto prediction_s = [&](TimeNs longest_ns) {
    return seconds_from_ns(std::clamp<TimeNs>(now_ns - t_capture_ns_, 0, longest_ns));
  };
  const Eigen::Vector2d position_odom_m =
      position_.position() + prediction_s(kLongestWalk_ns) * position_.velocity();
  const double yaw_odom_rad = yaw_.position()(0) + prediction_s(kLongestTurn_ns) * yaw_.velocity()(0);

  const Eigen::Matrix2d R_robot_from_odom = rotation(-robot->heading_rad);
  const Eigen::Vector2d position_m =
      R_robot_from_odom * (position_odom_m - Eigen::Vector2d(robot->x_m, robot->y_m));
  const double yaw_rad = wrap_angle_rad(yaw_odom_rad - robot->heading_rad);

  const DirectionEstimate travel = travel_.travel(prediction_s(kLongestTurn_ns));
  const DirectionEstimate stride = travel_.stride();
  const double travel_yaw_rad = wrap_angle_rad(travel.angle_rad - robot->heading_rad);

  // At the goal the camera has the person where the reference view has them, moved by the set points, and the
  // robot heads in the direction of travel: that of the back would swing the goal with each stride. The mount
  // leads from the camera to the robot's centre.
  const Eigen::Vector2d person_from_camera_m =
      in_reference_view_m_ + Eigen::Vector2d(set_points_.t_z_m, -set_points_.t_x_m);
  const Eigen::Vector2d person_from_robot_m = person_from_camera_m + Eigen::Vector2d(mount_.x_m, mount_.y_m);
  const Eigen::Vector2d goal_m =
      position_m - rotation(travel_yaw_rad + set_points_.yaw_rad) * person_from_robot_m;

  target.known = true;
  target.t_capture_ns = t_capture_ns_;
  target.certainty = certainty_;
  target.x_m = position_m.x();
  target.y_m = position_m.y();
  target.yaw_rad = yaw_rad;
  target.travel_yaw_rad = travel_yaw_rad;
  target.travel_yaw_sigma_rad = travel.sigma_rad;
  target.stride_yaw_rad = wrap_angle_rad(stride.angle_rad - robot->heading_rad);
  target.stride_yaw_sigma_rad = stride.sigma_rad;
  const TravelFilter::Walk walk = travel_.walk();
  target.body_odom_x_m = walk.position_m.x();
  target.body_odom_y_m = walk.position_m.y();
  target.body_sigma_m = walk.position_sigma_m;
  target.walk_m_s = walk.forwards_m_s;
  target.walk_sigma_m_s = walk.forwards_sigma_m_s;
  target.aside_m_s = walk.aside_m_s;
  target.walk_turn_rad_s = walk.turn_rad_s;
  target.walk_turn_sigma_rad_s = walk.turn_sigma_rad_s;
  target.goal_x_m = goal_m.x();
  target.goal_y_m = goal_m.y();
  return target;
}

}  // namespace heel
