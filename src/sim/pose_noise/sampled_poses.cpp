#include "sim/pose_noise/sampled_poses.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/angles.h"
#include "sim/pose_noise/error_fit.h"

namespace heel::sim {
namespace {

constexpr TimeNs kTrackingEnd_ns = kNsPerS / 2;  ///< after this time PoseTracker searches the whole frame
constexpr std::uint32_t kTemplateFeatures = 300;

double normal_cdf(double value) {
  return 0.5 * std::erfc(-value / std::sqrt(2.0));
}

double quantile(const Quantiles& quantiles, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kQuantiles - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kQuantiles - 2);
  return quantiles[low] + (at - static_cast<double>(low)) * (quantiles[low + 1] - quantiles[low]);
}

/// R_cur_from_ref for an upright person with this heading.
Eigen::Matrix3d rotation_of(const Eigen::Isometry3d& world_from_camera, double heading_rad) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  Eigen::Matrix3d world_from_ref;
  world_from_ref << s, 0, c, -c, 0, s, 0, -1, 0;
  return world_from_camera.linear().transpose() * world_from_ref;
}

}  // namespace

SampledPoses::SampledPoses(const ErrorModel& model, const Scenario& scenario, double distance_m,
                           std::uint64_t seed)
    : model_(model),
      camera_(scenario.camera.model),
      exposure_s_(1e-3 * scenario.camera.sensor.exposure_ms),
      light_(scenario.light.level),
      other_print_(scenario.person.shirt != ShirtDesign::Bold),
      distance_m_(distance_m),
      mount_z_m_(scenario.camera.mount_z_m),
      random_(seed) {
  found_.memory_s = model.found_memory_s;
  const auto begin = [&](CorrelatedNoise& noise, const SpreadModel& spread) {
    noise.constant_share = spread.print_share;
    noise.memory_s = spread.memory_s;
    noise.constant = random_.normal();
  };
  begin(aspect_, model.aspect_rad);
  begin(range_, model.range_share);
  begin(bearing_, model.bearing_rad);
}

double SampledPoses::next(CorrelatedNoise& noise, double dt_s) {
  const double correlation = noise.memory_s > 0.0 ? std::exp(-dt_s / noise.memory_s) : 0.0;
  noise.varying = correlation * noise.varying + std::sqrt(1.0 - correlation * correlation) * random_.normal();
  return std::sqrt(noise.constant_share) * noise.constant +
         std::sqrt(1.0 - noise.constant_share) * noise.varying;
}

double SampledPoses::sample(const SpreadModel& model, const ViewConditions& conditions,
                            CorrelatedNoise& noise, double dt_s) {
  const double residual = quantile(model.residual, normal_cdf(next(noise, dt_s)));
  return model.bias(conditions) + model.spread(conditions) * residual;
}

ViewConditions SampledPoses::conditions_of_frame(const RobotMotion& robot, const Truth& truth) const {
  const Eigen::Vector3d& back = truth.back_in_camera_m;
  ViewConditions now = conditions_of(back.x(), back.z(), truth.yaw_rad, camera_.fx, camera_.cx,
                                     static_cast<double>(camera_.width_px), 0.0);
  // Most of the blur comes from the rotation of the camera; walking adds little at two metres.
  const double sideways_m_s = truth.person.speed_m_s * std::sin(now.aspect_rad) +
                              robot.v_m_s * std::sin(std::atan2(back.x(), back.z()));
  const double rate_rad_s = robot.yaw_rate_rad_s + sideways_m_s / std::max(now.distance_m, 0.1);
  now.blur_px = camera_.fx * std::abs(rate_rad_s) * exposure_s_;
  now.light = light_;
  now.other_print = other_print_;
  return now;
}

PoseEstimate SampledPoses::estimate(const FrameHeader& header, const RobotMotion& robot, const Truth& truth) {
  const TimeNs t_ns = header.t_capture_ns;
  const double dt_s = started_ ? seconds_from_ns(t_ns - t_last_ns_) : 1e9;
  if (!started_) back_z_m_ = truth.back_m.z();
  started_ = true;
  t_last_ns_ = t_ns;
  PoseEstimate pose;
  pose.frame_sequence = header.sequence;
  pose.t_capture_ns = t_ns;
  pose.template_features = kTemplateFeatures;

  ViewConditions now = conditions_of_frame(robot, truth);
  now.whole_frame_search = !ever_found_ || t_ns - t_last_found_ns_ > kTrackingEnd_ns;
  // Every random number is drawn for every frame, so that one value does not change the sequence of the
  // others.
  const double found = normal_cdf(next(found_, dt_s));
  const double aspect_error = sample(model_.aspect_rad, now, aspect_, dt_s);
  const double range_error = sample(model_.range_share, now, range_, dt_s);
  const double bearing_error = sample(model_.bearing_rad, now, bearing_, dt_s);
  const double flip = random_.uniform();
  const double certainty =
      std::exp(model_.certainty.mean_log(now) + model_.certainty.log_deviation * random_.normal());
  const double sigma_rad =
      std::exp(model_.yaw_sigma_rad.mean_log(now) + model_.yaw_sigma_rad.log_deviation * random_.normal());
  const double log_time = model_.time_share.log_deviation * random_.normal();

  if (!truth.in_view || truth.occluded || found >= model_.found_probability(now)) {
    pose.reason = PoseReason::TooFewInliers;
    time_share_ = std::exp(model_.missed_log_time_share);
    return pose;
  }
  time_share_ = std::exp(model_.time_share.mean_log(now) + log_time);
  pose.reason = PoseReason::Found;
  pose.tracked = !now.whole_frame_search;
  pose.certainty = std::min(certainty, 1.0);
  pose.inliers = static_cast<std::uint32_t>(pose.certainty * kTemplateFeatures);
  pose.yaw_sigma_rad = pose.frame_yaw_sigma_rad = sigma_rad;
  ever_found_ = true;
  t_last_found_ns_ = t_ns;

  const double aspect = flip < model_.flip_probability(now) ? -now.aspect_rad : now.aspect_rad;
  const double bearing = std::atan2(truth.back_in_camera_m.x(), truth.back_in_camera_m.z()) + bearing_error;
  set_pose(truth, wrap_angle_rad(aspect + aspect_error + bearing), bearing,
           now.distance_m * (1.0 + range_error), pose);
  return pose;
}

void SampledPoses::set_pose(const Truth& truth, double yaw_rad, double bearing_rad, double range_m,
                            PoseEstimate& pose) const {
  const Eigen::Vector3d& back = truth.back_in_camera_m;
  const double range_ratio = range_m / std::hypot(back.x(), back.z());
  const Eigen::Vector3d position(range_m * std::sin(bearing_rad), range_ratio * back.y(),
                                 range_m * std::cos(bearing_rad));
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(yaw_rad - truth.yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix() *
      rotation_of(truth.world_from_camera, truth.back_yaw_rad);
  const Eigen::Vector3d centre_ref(0.0, mount_z_m_ - back_z_m_, distance_m_);
  const Eigen::Vector3d t_over_d = (position - R * centre_ref) / distance_m_;
  const Eigen::Matrix3d K = camera_.K();
  Eigen::Matrix3d H = R;
  H.col(2) += t_over_d;
  H = (K * H * K.inverse()).eval();
  pose.yaw_rad = pose.frame_yaw_rad = yaw_rad;
  Eigen::Map<Eigen::Vector3d>(pose.t_over_d.data()) = t_over_d;
  // t changes with the yaw by the lever of the template's distance.
  Eigen::Map<Eigen::Vector3d>(pose.t_over_d_sigma.data()) =
      pose.yaw_sigma_rad * Eigen::Vector3d(std::abs(std::cos(yaw_rad)), 0.0, std::abs(std::sin(yaw_rad)));
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.R_cur_from_ref.data()) = R;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.H_cur_from_ref.data()) = H / H(2, 2);
  pose.has_distance = true;
  Eigen::Map<Eigen::Vector3d>(pose.position_m.data()) = position;
}

}  // namespace heel::sim
