// The yaw of the back over the frames of a sequence: a Kalman filter with constant yaw rate, disturbed by
// white angular acceleration.
//
// A single frame's yaw is wrong by two parts: what the cloth does within a stride, which lasts a fraction of
// a second, and how the cloth hung when it was taught, which stays. The filter averages the first; the second
// remains in the deviation that it states.
//
// Units: radians, nanoseconds.
#pragma once

#include <Eigen/Core>

#include "heel/time.h"

namespace heel {

struct FilteredYaw {
  double yaw_rad = 0.0;
  double sigma_rad = 0.0;  ///< one standard deviation
};

class YawFilter {
 public:
  /// `yaw_rad`, `sigma_rad`: of one frame. A frame that is not later than the last one, or later by more than
  /// half a second, starts the filter again.
  FilteredYaw update(TimeNs t_ns, double yaw_rad, double sigma_rad);

 private:
  FilteredYaw start(TimeNs t_ns, double yaw_rad, double sigma_rad);

  bool started_ = false;
  TimeNs t_ns_ = 0;
  Eigen::Vector2d state_ = Eigen::Vector2d::Zero();  ///< yaw and yaw rate: rad, rad/s
  Eigen::Matrix2d P_ = Eigen::Matrix2d::Zero();      ///< covariance of state_
};

}  // namespace heel
