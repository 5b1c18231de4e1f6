// A pose on the floor: x forward, y left, heading counter-clockwise, in the frame that the variable names.
#pragma once

namespace heel {

struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< continuous where it is integrated, otherwise as given
};

}  // namespace heel
