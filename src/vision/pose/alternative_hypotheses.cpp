#include "vision/pose/alternative_hypotheses.h"

#include <cmath>

#include "core/angles.h"
#include "heel/motion.h"

namespace heel {

double yaw_difference_rad(const FrontalMotion& a, const FrontalMotion& b) {
  return std::abs(wrap_angle_rad(yaw_of_rotation(a.R_cur_from_ref) - yaw_of_rotation(b.R_cur_from_ref)));
}

void inflate_covariance(std::span<const AlternativeHypothesis> alternatives, FrontalPose& pose) {
  double odds = 0.0, yaw_rad2 = 0.0;
  Eigen::Vector3d t_over_d2 = Eigen::Vector3d::Zero();
  for (const AlternativeHypothesis& alternative : alternatives) {
    const double yaw_error_rad = yaw_difference_rad(alternative.motion, pose.motion);
    odds += alternative.odds;
    yaw_rad2 += alternative.odds * yaw_error_rad * yaw_error_rad;
    t_over_d2 += alternative.odds * (alternative.motion.t_over_d - pose.motion.t_over_d).cwiseAbs2();
  }
  pose.ambiguity = 1.0 - (1.0 - pose.ambiguity) / (1.0 + odds);
  pose.yaw_sigma_rad = std::sqrt(pose.yaw_sigma_rad * pose.yaw_sigma_rad + yaw_rad2 / (1.0 + odds));
  pose.t_over_d_sigma = (pose.t_over_d_sigma.cwiseAbs2() + t_over_d2 / (1.0 + odds)).cwiseSqrt();
}

}  // namespace heel
