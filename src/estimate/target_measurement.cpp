#include "estimate/target_measurement.h"

#include <Eigen/Geometry>
#include <cmath>

namespace heel {

CameraMount mount_of(const CameraConfig& camera) {
  return {camera.mount_x_m,       camera.mount_y_m,     camera.mount_z_m,
          camera.mount_pitch_rad, camera.mount_yaw_rad, camera.mount_roll_rad};
}

Eigen::Matrix3d R_robot_from_camera(const CameraMount& mount) {
  const double c = std::cos(mount.pitch_rad);
  const double s = std::sin(mount.pitch_rad);
  Eigen::Matrix3d R_tilted;
  R_tilted << 0, s, c,  //
      -1, 0, 0,         //
      0, -c, s;
  return Eigen::AngleAxisd(mount.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R_tilted *
         Eigen::AngleAxisd(mount.roll_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

std::optional<TargetMeasurement> measurement_from_pose(const PoseEstimate& pose, const CameraMount& mount) {
  if (!pose.found() || !pose.has_distance) return std::nullopt;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_cur_from_ref(
      pose.R_cur_from_ref.data());
  const Eigen::Map<const Eigen::Vector3d> t_over_d(pose.t_over_d.data());
  const Eigen::Map<const Eigen::Vector3d> position_m(pose.position_m.data());
  const Eigen::Matrix3d R_robot_from_cur = R_robot_from_camera(mount);

  // The centre c of the template satisfies  position = R c + d (t/d)  with c_z = d, so that
  //   d = e_z·Rᵀ position / (1 + e_z·Rᵀ (t/d)),
  // whose denominator is the present distance to the shirt's plane over d.
  const double plane_ratio = 1.0 + (R_cur_from_ref.transpose() * t_over_d).z();
  const double d_m = (R_cur_from_ref.transpose() * position_m).z() / plane_ratio;
  const Eigen::Vector3d centre_ref_m = R_cur_from_ref.transpose() * (position_m - d_m * t_over_d);

  const Eigen::Vector3d walking = R_robot_from_cur * R_cur_from_ref.col(2);
  const Eigen::Vector3d position_robot_m =
      Eigen::Vector3d(mount.x_m, mount.y_m, mount.z_m) + R_robot_from_cur * position_m;

  TargetMeasurement measurement;
  measurement.position_m = position_robot_m.head<2>();
  measurement.yaw_rad = std::atan2(walking.y(), walking.x());
  measurement.yaw_sigma_rad = pose.frame_yaw_sigma_rad;
  measurement.in_reference_view_m = {d_m, -centre_ref_m.x()};

  constexpr double kLeastHorizontalShare = 0.2;  // a back tilted by more than 78° shows no direction
  const bool valid = plane_ratio > 0.0 && d_m > 0.0 && walking.head<2>().norm() > kLeastHorizontalShare &&
                     measurement.position_m.allFinite() && measurement.in_reference_view_m.allFinite() &&
                     std::isfinite(measurement.yaw_rad) && std::isfinite(measurement.yaw_sigma_rad);
  if (!valid) return std::nullopt;
  return measurement;
}

}  // namespace heel
