// The shape of the robot as the control stage needs it. src/robot fills it in for the robot it drives.
#pragma once

#include <array>

#include "core/pose2.h"
#include "heel/flow.h"

namespace heel {

struct RobotGeometry {
  double centre_to_bumper_m = 0.0;  ///< along x, forwards and backwards
  double half_width_m = 0.0;
  /// Where each sonar sits in the robot frame; the heading is the middle of its beam.
  std::array<Pose2, kSonars> sonars{};
};

}  // namespace heel
