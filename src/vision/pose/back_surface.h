// The back as a surface over the reference view. A back is no plane: across it, it falls away from the camera
// as an ellipse does from its end, z = b (1 − √(1 − X²/a²)) ≈ κ X² with κ = b / (2 a²), for X from the
// middle. In units of the distance d of the middle, along the ray (x, y, 1) of the reference view:
//   X_ref / d = (x, y, 1) (1 + κ d (x − x_c)²)
// κ d = 0 is the paper's plane. No back stays that curve: cloth has folds, and slides, and the body breathes
// and sways. What has changed between the moment of teaching and now lifts the point off the surface, along
// the target's normal. The change is taken for smooth, a sum of five shapes of the place (u, v) in the
// region, −1…1:
//   δz = σ_shape (a₁ u + a₂ v + a₃ (u² − ⅓) + a₄ u v + a₅ (v² − ⅓)),  a ~ N(0, I)
// Smooth departures do not average out over many points, so they are what an honest deviation rests on; and
// so is the curvature, which is not known of anybody: κ ~ N(κ₀, σ_κ). It is the same at both moments, so that
// it moves a point along the reference's ray: from where the template was taken, it is not seen and turns
// nothing.
#pragma once

#include <Eigen/Core>

#include "vision/optimisation/projection.h"

namespace heel {

using Vector5d = Eigen::Matrix<double, 5, 1>;

struct BackSurface {
  double bend = 0.0;    ///< κ d
  double axis_x = 0.0;  ///< x_c, normalised reference coordinate of the back's middle
  double axis_y = 0.0;  ///< of its middle from top to bottom
  Eigen::Vector2d half_size = Eigen::Vector2d::Ones();  ///< of the region, normalised
  double shape_sigma = 0.0;                             ///< σ_shape / d
  double bend_sigma = 0.0;                              ///< σ_κ d: builds differ

  double depth_over_d(double x) const { return 1.0 + bend * (x - axis_x) * (x - axis_x); }

  /// X_ref / d under the normalised reference point (x, y, 1).
  Eigen::Vector3d point(const Eigen::Vector3d& ray) const { return depth_over_d(ray.x()) * ray; }

  /// How far each of the five shapes lifts the point off the surface, along the normal (0,0,1), in units of
  /// d.
  Vector5d departures(const Eigen::Vector3d& ray) const {
    const double u = (ray.x() - axis_x) / half_size.x(), v = (ray.y() - axis_y) / half_size.y();
    Vector5d shapes;
    shapes << u, v, u * u - 1.0 / 3.0, u * v, v * v - 1.0 / 3.0;
    return shape_sigma * shapes;
  }

  /// How far another build's curve lies behind this one: along the ray, since the reference view shows it at
  /// the same pixel; in units of d, one standard deviation.
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

/// How the surface's image moves with the reference pixel: d cur_px / d ref_px. Its determinant is negative
/// where the surface turns its inside to the current camera.
inline Eigen::Matrix2d image_derivative(const BackSurface& surface, const Eigen::Matrix3d& K_ref_inverse,
                                        const Eigen::Matrix3d& KR_cur, const Eigen::Vector3d& Kt_cur,
                                        const Eigen::Vector3d& ray) {
  return projection_jacobian(KR_cur * surface.point(ray) + Kt_cur) * KR_cur * surface.derivative(ray) *
         K_ref_inverse.topLeftCorner<2, 2>();
}

}  // namespace heel
