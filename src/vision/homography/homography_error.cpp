// Symmetric transfer error (Hartley & Zisserman, 2nd ed., Eq. (4.7)).
#include <Eigen/Geometry>
#include <limits>

#include "heel/homography.h"

namespace heel {

double symmetric_transfer_error_px2(const Eigen::Matrix3d& H_cur_from_ref,
                                    const Eigen::Matrix3d& H_ref_from_cur, const PointPair& pair) {
  const Eigen::Vector3d forward = H_cur_from_ref * pair.ref_px.homogeneous();
  const Eigen::Vector3d backward = H_ref_from_cur * pair.cur_px.homogeneous();
  const double error = (forward.hnormalized() - pair.cur_px).squaredNorm() +
                       (backward.hnormalized() - pair.ref_px).squaredNorm();
  return error >= 0.0 ? error : std::numeric_limits<double>::infinity();  // a point at infinity may give NaN
}

}  // namespace heel
