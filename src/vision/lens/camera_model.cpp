// Pinhole camera with plumb-bob or rational distortion, as in OpenCV and ROS: with r² = x² + y² in normalised
// coordinates and, in the rational model, the radial factor over 1 + k4 r² + k5 r⁴ + k6 r⁶:
//   x' = x (1 + k1 r² + k2 r⁴ + k3 r⁶) + 2 p1 x y + p2 (r² + 2 x²)
//   y' = y (1 + k1 r² + k2 r⁴ + k3 r⁶) + p1 (r² + 2 y²) + 2 p2 x y
#include "heel/camera_model.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/lens/lens_models.h"

namespace heel {
namespace {

constexpr int kMaxNewtonSteps = 50;
constexpr int kMaxHalvings = 30;
constexpr double kConverged_px = 1e-10;

template <bool kRational>
Eigen::Vector2d distort_normalised(const CameraModel& camera, const Eigen::Vector2d& point) {
  const double x = point.x(), y = point.y();
  const double r2 = x * x + y * y;
  const double radial = radial_factor<kRational>(camera, r2).value;
  return {x * radial + 2.0 * camera.p1 * x * y + camera.p2 * (r2 + 2.0 * x * x),
          y * radial + camera.p1 * (r2 + 2.0 * y * y) + 2.0 * camera.p2 * x * y};
}

template <bool kRational>
Eigen::Matrix2d distortion_jacobian(const CameraModel& camera, const Eigen::Vector2d& point) {
  const double x = point.x(), y = point.y();
  const double r2 = x * x + y * y;
  const auto [radial, slope] = radial_factor<kRational>(camera, r2);
  const double cross = x * y * slope + 2.0 * (camera.p1 * x + camera.p2 * y);
  Eigen::Matrix2d J;
  J << radial + x * x * slope + 2.0 * camera.p1 * y + 6.0 * camera.p2 * x, cross,  //
      cross, radial + y * y * slope + 6.0 * camera.p1 * y + 2.0 * camera.p2 * x;
  return J;
}

// Newton's method, each step halved until it lowers the error and stays where the mapping is one-to-one
// (det J > 0). The error never grows, so it cannot diverge: for a pixel beyond the fold of a strong barrel
// distortion, which no direction maps to, it stops at the nearest it can reach.
template <bool kRational>
Eigen::Vector2d undistort_normalised(const CameraModel& camera, const Eigen::Vector2d& goal) {
  const double converged = kConverged_px / std::max(std::abs(camera.fx), std::abs(camera.fy));

  // The pixel itself is a good start inside the fold; beyond it, the centre is always inside.
  Eigen::Vector2d point = goal;
  if (distortion_jacobian<kRational>(camera, point).determinant() <= 0.0) point.setZero();
  Eigen::Vector2d residual = goal - distort_normalised<kRational>(camera, point);
  for (int step_count = 0; step_count < kMaxNewtonSteps && residual.norm() > converged; ++step_count) {
    Eigen::Vector2d step = distortion_jacobian<kRational>(camera, point).inverse() * residual;
    bool improved = false;
    for (int halving = 0; halving < kMaxHalvings && !improved; ++halving, step *= 0.5) {
      const Eigen::Vector2d trial = point + step;
      const Eigen::Vector2d trial_residual = goal - distort_normalised<kRational>(camera, trial);
      if (trial_residual.norm() < residual.norm() &&
          distortion_jacobian<kRational>(camera, trial).determinant() > 0.0) {
        point = trial;
        residual = trial_residual;
        improved = true;
      }
    }
    if (!improved) break;
  }
  return point;
}

}  // namespace

Eigen::Matrix3d CameraModel::K() const {
  Eigen::Matrix3d K;
  K << fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0;
  return K;
}

Eigen::Vector2d CameraModel::distort_px(const Eigen::Vector2d& undistorted_px) const {
  if (!distorted()) return undistorted_px;
  const Eigen::Vector2d normalised((undistorted_px.x() - cx) / fx, (undistorted_px.y() - cy) / fy);
  const Eigen::Vector2d bent = lens == LensModel::PlumbBob   ? distort_normalised<false>(*this, normalised)
                               : lens == LensModel::Rational ? distort_normalised<true>(*this, normalised)
                                                             : distort_fisheye(*this, normalised);
  return {fx * bent.x() + cx, fy * bent.y() + cy};
}

Eigen::Vector2d CameraModel::undistort_px(const Eigen::Vector2d& distorted_px) const {
  if (!distorted() || !distorted_px.allFinite()) return distorted_px;
  const Eigen::Vector2d goal((distorted_px.x() - cx) / fx, (distorted_px.y() - cy) / fy);
  const Eigen::Vector2d point = lens == LensModel::PlumbBob   ? undistort_normalised<false>(*this, goal)
                                : lens == LensModel::Rational ? undistort_normalised<true>(*this, goal)
                                                              : undistort_fisheye(*this, goal);
  return {fx * point.x() + cx, fy * point.y() + cy};
}

}  // namespace heel
