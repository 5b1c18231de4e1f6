#include "vision/pose/alternative_hypotheses.h"

#include <cmath>

#include "core/angles.h"
#include "heel/motion.h"

namespace heel {

double yaw_between(const FrontalMotion& a, const FrontalMotion& b) {
  return std::abs(wrap_angle_rad(yaw_of_rotation(a.R_cur_from_ref) - yaw_of_rotation(b.R_cur_from_ref)));
}

void inflate_covariance(std::span<const AlternativeHypothesis> alternative_hypotheses, FrontalPose& pose) {
  double odds = 0.0, yaw_rad2 = 0.0;
  Eigen::Vector3d t_over_d2 = Eigen::Vector3d::Zero();
  for (const AlternativeHypothesis& rival : alternative_hypotheses) {
    const double apart_rad = yaw_between(rival.motion, pose.motion);
    odds += rival.odds;
    yaw_rad2 += rival.odds * apart_rad * apart_rad;
    t_over_d2 += rival.odds * (rival.motion.t_over_d - pose.motion.t_over_d).cwiseAbs2();
  }
  pose.ambiguity = 1.0 - (1.0 - pose.ambiguity) / (1.0 + odds);
  pose.yaw_sigma_rad = std::sqrt(pose.yaw_sigma_rad * pose.yaw_sigma_rad + yaw_rad2 / (1.0 + odds));
  pose.t_over_d_sigma = (pose.t_over_d_sigma.cwiseAbs2() + t_over_d2 / (1.0 + odds)).cwiseSqrt();
}

}  // namespace heel
