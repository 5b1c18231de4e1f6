// An exact world: a person and a robot on a floor, and the pose that a perfect camera measures.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "estimate/odometry_history.h"
#include "estimate/target_measurement.h"
#include "heel/flow.h"
#include "heel/vision_config.h"

namespace heel::test {

/// Where the template's centre was in the reference camera when it was taken (x right, y down, z = distance).
struct Reference {
  Eigen::Vector3d centre_m{0.0, 0.0, 2.0};
  double distance_m() const { return centre_m.z(); }
};

inline Eigen::Matrix3d about_z(double angle_rad) {
  return Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// What vision reports when the camera on `robot` sees `person` (heading: walking direction; the back's
/// centre at `back_z_m`). Computed only from X_cur = R X_ref + t.
inline PoseEstimate measured(const Pose2& person, const Pose2& robot, const CameraMount& mount,
                             const Reference& reference, double back_z_m = 1.2) {
  const Eigen::Matrix3d R_odom_from_ref = about_z(person.heading_rad) * R_robot_from_camera({});
  const Eigen::Vector3d back_odom_m(person.x_m, person.y_m, back_z_m);
  const Eigen::Vector3d ref_camera_odom_m = back_odom_m - R_odom_from_ref * reference.centre_m;

  const Eigen::Matrix3d R_odom_from_cur = about_z(robot.heading_rad) * R_robot_from_camera(mount);
  const Eigen::Vector3d cur_camera_odom_m =
      Eigen::Vector3d(robot.x_m, robot.y_m, 0) +
      about_z(robot.heading_rad) * Eigen::Vector3d(mount.x_m, mount.y_m, mount.z_m);

  const Eigen::Matrix3d R_cur_from_ref = R_odom_from_cur.transpose() * R_odom_from_ref;
  const Eigen::Vector3d t_m = R_odom_from_cur.transpose() * (ref_camera_odom_m - cur_camera_odom_m);
  const Eigen::Vector3d position_m = R_cur_from_ref * reference.centre_m + t_m;

  PoseEstimate pose;
  pose.reason = PoseReason::Found;
  pose.certainty = 0.4;
  pose.has_distance = true;
  for (int i = 0; i < 3; ++i) {
    pose.t_over_d[static_cast<std::size_t>(i)] = t_m(i) / reference.distance_m();
    pose.position_m[static_cast<std::size_t>(i)] = position_m(i);
    for (int j = 0; j < 3; ++j)
      pose.R_cur_from_ref[static_cast<std::size_t>(3 * i + j)] = R_cur_from_ref(i, j);
  }
  pose.yaw_rad = std::atan2(R_cur_from_ref(0, 2), R_cur_from_ref(2, 2));
  return pose;
}

/// The exact motion of a unicycle.
inline Pose2 moved(const Pose2& from, double v_m_s, double yaw_rate_rad_s, double dt_s) {
  const double half = 0.5 * yaw_rate_rad_s * dt_s;
  const double chord_m = v_m_s * dt_s * (std::abs(half) < 1e-9 ? 1.0 : std::sin(half) / half);
  return {from.x_m + chord_m * std::cos(from.heading_rad + half),
          from.y_m + chord_m * std::sin(from.heading_rad + half), from.heading_rad + 2.0 * half};
}

/// A point of the odometry frame, in the frame of `robot`.
inline Eigen::Vector2d in_robot(const Pose2& robot, double x_m, double y_m) {
  return Eigen::Rotation2Dd(-robot.heading_rad) * Eigen::Vector2d(x_m - robot.x_m, y_m - robot.y_m);
}

inline Odometry odometry(TimeNs t_ns, const Pose2& robot, double v_m_s, double yaw_rate_rad_s) {
  return {t_ns, robot.x_m, robot.y_m, robot.heading_rad, v_m_s, yaw_rate_rad_s};
}

}  // namespace heel::test
