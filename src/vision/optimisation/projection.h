// The derivative of the projection of a homogeneous point: (x, y, w) → (x/w, y/w).
#pragma once

#include <Eigen/Core>

namespace heel {

using Matrix23d = Eigen::Matrix<double, 2, 3>;

/// d (x/w, y/w) / d (x, y, w).
inline Matrix23d projection_jacobian(const Eigen::Vector3d& point) {
  const double inverse_w = 1.0 / point.z();
  Matrix23d J;
  J << inverse_w, 0.0, -point.x() * inverse_w * inverse_w,  //
      0.0, inverse_w, -point.y() * inverse_w * inverse_w;
  return J;
}

}  // namespace heel
