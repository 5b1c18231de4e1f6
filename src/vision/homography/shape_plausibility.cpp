#include "vision/homography/shape_plausibility.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace heel {
namespace {

/// d (x, y)_cur / d (x, y)_ref.
Eigen::Matrix2d derivative(const Eigen::Matrix3d& H, const Eigen::Vector2d& ref_px) {
  const Eigen::Vector3d p = H * ref_px.homogeneous();
  Eigen::Matrix2d J;
  for (int axis = 0; axis < 2; ++axis) {
    J(0, axis) = (H(0, axis) - p.x() / p.z() * H(2, axis)) / p.z();
    J(1, axis) = (H(1, axis) - p.y() / p.z() * H(2, axis)) / p.z();
  }
  return J;
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Twice the signed area.
double area2(const Outline& outline) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) sum += cross(outline[i], outline[(i + 1) % 4]);
  return sum;
}

/// All four corners turn in the direction of the reference's `orientation`.
bool convex_like(const Outline& outline, double orientation) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d edge = outline[(i + 1) % 4] - outline[i];
    const Eigen::Vector2d next = outline[(i + 2) % 4] - outline[(i + 1) % 4];
    if (!(cross(edge, next) * orientation > 0.0)) return false;
  }
  return true;
}

}  // namespace

double local_scale(const Eigen::Matrix3d& H_cur_from_ref, const Eigen::Vector2d& ref_px) {
  return std::sqrt(std::abs(derivative(H_cur_from_ref, ref_px).determinant()));
}

bool plausible_shape(const Eigen::Matrix3d& H_cur_from_ref, const Outline& outline_ref_px,
                     const ShapeLimits& limits) {
  Outline outline_cur_px;
  double w_min = 0.0, w_max = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d p = H_cur_from_ref * outline_ref_px[i].homogeneous();
    w_min = i == 0 ? p.z() : std::min(w_min, p.z());
    w_max = i == 0 ? p.z() : std::max(w_max, p.z());
    outline_cur_px[i] = p.hnormalized();
  }
  // Depths are proportional to w; H may have either sign.
  if (w_max < 0.0) {
    std::swap(w_min, w_max);
    w_min = -w_min;
    w_max = -w_max;
  }
  if (!(w_min > 0.0) || w_max > limits.depth_ratio_max * w_min) return false;
  if (!convex_like(outline_cur_px, area2(outline_ref_px))) return false;

  const double scale = std::sqrt(area2(outline_cur_px) / area2(outline_ref_px));
  if (!(scale >= limits.scale_min && scale <= limits.scale_max)) return false;

  const Eigen::Vector2d centre =
      0.25 * (outline_ref_px[0] + outline_ref_px[1] + outline_ref_px[2] + outline_ref_px[3]);
  const Eigen::Matrix2d J = derivative(H_cur_from_ref, centre);
  // Singular values p ≥ q of J: p² + q² = |J|², p q = det J; q / p = det J / p².
  const double sum2 = J.squaredNorm(), product = J.determinant();
  const double longer2 = 0.5 * (sum2 + std::sqrt(std::max(0.0, sum2 * sum2 - 4.0 * product * product)));
  return product >= limits.squeeze_min * longer2;
}

}  // namespace heel
