#include "sim/scene/rigid_fit.h"

#include <Eigen/Geometry>

namespace heel::sim {

RigidFit fit_rigid(const std::vector<Eigen::Vector3d>& from_m, const std::vector<Eigen::Vector3d>& to_m) {
  const auto count = static_cast<Eigen::Index>(from_m.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = from_m[static_cast<std::size_t>(i)];
    to.col(i) = to_m[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix4d to_from = Eigen::umeyama(from, to, false);
  return {to_from.topLeftCorner<3, 3>(), to_from.topRightCorner<3, 1>()};
}

}  // namespace heel::sim
