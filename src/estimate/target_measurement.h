// The person's position and walking direction on the floor, from one frame's pose of the shirt.
//   camera frame  x right, y down, z forward        robot frame  x forward, y left, z up
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/config.h"
#include "heel/flow.h"

namespace heel {

/// Where the camera's optical centre sits in the robot frame, and its attitude: + pitch looks up, + yaw to
/// the left, + roll lowers the camera's right side.
struct CameraMount {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;
  double roll_rad = 0.0;
};
CameraMount mount_of(const CameraConfig& camera);

/// Columns: the camera's axes in the robot frame.
Eigen::Matrix3d R_robot_from_camera(const CameraMount& mount);

/// The person as measured in one frame, in the robot frame at the capture time.
struct TargetMeasurement {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< centre of the back
  double yaw_rad = 0.0;        ///< walking direction against the robot's heading, counter-clockwise +
  double yaw_sigma_rad = 0.0;  ///< from vision
  /// Where the reference view has the person: this far ahead of the camera and to its left.
  Eigen::Vector2d in_reference_view_m = Eigen::Vector2d::Zero();
};

/// No value when the pose was not found, is not metric, is not finite, or shows no walking direction (a back
/// that lies flat).
std::optional<TargetMeasurement> measurement_from_pose(const PoseEstimate& pose, const CameraMount& mount);

}  // namespace heel
