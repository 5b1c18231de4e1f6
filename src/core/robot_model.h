// A robot of the ARCOS family: what one subclass has in other units or in another shape than the others.
#pragma once

#include <string>

#include "core/robot_geometry.h"

namespace heel {

struct RobotModel {
  std::string subclass;  ///< as the robot names itself, "p3at-sh"
  // Wire units.
  double mm_per_position_unit = 1.0;  ///< DistConvFactor
  double mm_s_per_speed_unit = 1.0;   ///< VelConvFactor, of the speeds in a SIP; commands are in mm/s
  double mm_per_range_unit = 1.0;     ///< RangeConvFactor
  int heading_units_per_turn = 4096;  ///< 2π / AngleConvFactor
  double effective_track_m = 0.0;     ///< 2 / DiffConvFactor: difference of the wheels' speeds / yaw rate
  // The largest that may be asked for.
  int v_max_mm_s = 0;
  int yaw_rate_max_deg_s = 0;
  // Seen from above.
  double width_m = 0.0;
  double length_m = 0.0;
  double radius_m = 0.0;
  RobotGeometry geometry;
};

}  // namespace heel
