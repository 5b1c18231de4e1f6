// What the page needs to know of this heeld beside the records: it does not change while it runs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/robot_model.h"
#include "heel/camera_model.h"
#include "heel/flow.h"

namespace heel {

/// A template in undistorted pixels of its own camera.
struct ShownTemplate {
  std::array<Eigen::Vector2d, 4> corners_px;  ///< of its region: top left, then clockwise
  double width_m = 0.0, height_m = 0.0, distance_m = 0.0;
};

struct ViewFacts {
  CameraModel camera;
  std::vector<ShownTemplate> templates;  ///< in the order of PoseEstimate::template_index
};

/// The model of the robot that is driven; before it has said what it is, the one of robot.model or the first.
const RobotModel& shown_robot(const RobotState& robot, const std::string& configured);

}  // namespace heel
