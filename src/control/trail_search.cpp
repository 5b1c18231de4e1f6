#include "control/trail_search.h"

#include <algorithm>
#include <cmath>

#include "core/angles.h"

namespace heel {
namespace {

constexpr double kThere_rad = 0.05;
constexpr double kGain_1_s = 1.5;
constexpr TimeNs kLook_ns = 700 * kNsPerMs;  // vision searches the whole frame for some frames

}  // namespace

void TrailSearch::begin(double heading_rad, double side) {
  heading_rad_ = heading_rad;
  side_ = side < 0.0 ? -1.0 : 1.0;
  step_ = Step::First;
  t_there_ns_ = 0;
}

double TrailSearch::yaw_rate_rad_s(double robot_heading_rad, TimeNs now_ns) {
  if (step_ != Step::First && step_ != Step::Other) return 0.0;
  const double look_rad = step_ == Step::First ? side_ * look_rad_ : -side_ * look_rad_;
  // Not wrapped from one side to the other: the turn leads back over the middle.
  const double missing_rad = look_rad - wrap_angle_rad(robot_heading_rad - heading_rad_);
  if (std::abs(missing_rad) > kThere_rad && t_there_ns_ == 0)
    return std::clamp(kGain_1_s * missing_rad, -turn_rad_s_, turn_rad_s_);
  if (t_there_ns_ == 0) t_there_ns_ = now_ns;
  if (now_ns - t_there_ns_ >= kLook_ns) {
    step_ = step_ == Step::First ? Step::Other : Step::Done;
    t_there_ns_ = 0;
  }
  return 0.0;
}

}  // namespace heel
