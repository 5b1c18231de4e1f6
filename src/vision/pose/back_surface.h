// The back as a surface over the reference view, and how far a real back departs from it.
//
// Convention: reference camera frame, x right, y down, z forward; the middle of the back lies at z = d,
// normal (0,0,1).
// Units: lengths in units of d; x, y are normalised image coordinates, the ray being (x, y, 1).
//
// Curvature. A horizontal section of a back is like the end of an ellipse with half axes a and b: with X
// measured from the middle, its sides lie z = b (1 − √(1 − X²/a²)) ≈ κ X² behind it, κ = b / (2 a²). So
//   X_ref / d = (x, y, 1) (1 + κ d (x − x_c)²);
// κ d = 0 is the plane of the paper. The curvature of a person is unknown, κ ~ N(κ₀, σ_κ), but the same in
// the reference view and now. An error of κ moves a point along its reference ray, which the reference view
// cannot show; so it causes no error of the pose near the reference view.
//
// Change of shape. Between the reference view and now cloth folds and slides, and the body breathes and
// sways. This moves the points along the normal. The change is modelled as smooth: the sum of five shapes
// over the region, (u, v) in −1…1,
//   δz = σ_shape (a₁ u + a₂ v + a₃ (u² − ⅓) + a₄ u v + a₅ (v² − ⅓)),  a ~ N(0, I).
// Smooth departures do not average out over many points; therefore they dominate the sigma of the pose.
#pragma once

#include <Eigen/Core>

#include "vision/optimisation/projection.h"

namespace heel {

using Vector5d = Eigen::Matrix<double, 5, 1>;

struct BackSurface {
  double bend = 0.0;                                    ///< κ d
  double axis_x = 0.0;                                  ///< x_c, of the middle of the back
  double axis_y = 0.0;                                  ///< y of the middle of the region
  Eigen::Vector2d half_size = Eigen::Vector2d::Ones();  ///< half width and height of the region
  double shape_sigma = 0.0;                             ///< σ_shape / d
  double bend_sigma = 0.0;                              ///< σ_κ d: people differ

  double depth_over_d(double x) const { return 1.0 + bend * (x - axis_x) * (x - axis_x); }

  /// X_ref / d under the normalised reference point (x, y, 1).
  Eigen::Vector3d point(const Eigen::Vector3d& ray) const { return depth_over_d(ray.x()) * ray; }

  /// How far each of the five shapes moves the point along the normal (0,0,1), one standard deviation.
  Vector5d departures(const Eigen::Vector3d& ray) const {
    const double u = (ray.x() - axis_x) / half_size.x(), v = (ray.y() - axis_y) / half_size.y();
    Vector5d shapes;
    shapes << u, v, u * u - 1.0 / 3.0, u * v, v * v - 1.0 / 3.0;
    return shape_sigma * shapes;
  }

  /// How far an error of the curvature moves the point along its ray, one standard deviation.
  double departure_of_bend(const Eigen::Vector3d& ray) const {
    return bend_sigma * (ray.x() - axis_x) * (ray.x() - axis_x);
  }

  /// d point / d (x, y).
  Eigen::Matrix<double, 3, 2> derivative(const Eigen::Vector3d& ray) const {
    Eigen::Matrix<double, 3, 2> by_xy;
    const double s = depth_over_d(ray.x());
    by_xy.col(0) = s * Eigen::Vector3d::UnitX() + 2.0 * bend * (ray.x() - axis_x) * ray;
    by_xy.col(1) = s * Eigen::Vector3d::UnitY();
    return by_xy;
  }
};

/// d cur_px / d ref_px of the image of the surface. Its determinant is negative where the current camera sees
/// the inside of the surface.
inline Eigen::Matrix2d image_derivative(const BackSurface& surface, const Eigen::Matrix3d& K_ref_inverse,
                                        const Eigen::Matrix3d& KR_cur, const Eigen::Vector3d& Kt_cur,
                                        const Eigen::Vector3d& ray) {
  return projection_jacobian(KR_cur * surface.point(ray) + Kt_cur) * KR_cur * surface.derivative(ray) *
         K_ref_inverse.topLeftCorner<2, 2>();
}

}  // namespace heel
