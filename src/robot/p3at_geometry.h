// The Pioneer P3-AT's outline and sonars, from its manual.
#pragma once

#include "core/robot_geometry.h"

namespace heel {

RobotGeometry p3at_geometry();

}  // namespace heel
