// The back as a surface over the reference view, and how far a real back departs from it.
//
// Convention: reference camera frame, x right, y down, z forward; the middle of the back lies at z = d,
// normal (0,0,1); (u, v) is the place in the template's region, −1…1 from edge to edge.
// Units: lengths in units of d; x, y are normalised image coordinates, the ray being (x, y, 1).
//
// Shape. A back is flat in the middle, with a hollow between the shoulder blades; its sides fall away more
// steeply than a parabola, and the waist comes nearer again. A polynomial describes this:
//   X_ref / d = (x, y, 1) (1 + δ(u, v)),  δ = c₁ u² + c₂ u⁴ + c₃ v + c₄ v² + c₅ v³ + c₆ u² v.
// All coefficients 0 is the plane of the paper. The shape of a person is unknown, but the same in the
// reference view and now: an error of curvature, σ_κ, moves a point along its reference ray, which the
// reference view cannot show; so it causes no error of the pose near the reference view.
//
// Change of shape. Between the reference view and now cloth folds and slides, and the body breathes and
// sways. This moves the points along the normal. The change is modelled as smooth: the sum of five shapes,
//   δz = σ_shape (a₁ u + a₂ v + a₃ (u² − ⅓) + a₄ u v + a₅ (v² − ⅓)),  a ~ N(0, I).
// Smooth departures do not average out over many points; therefore they dominate the sigma of the pose.
#pragma once

#include <Eigen/Core>

#include "vision/optimisation/projection.h"

namespace heel {

using Vector5d = Eigen::Matrix<double, 5, 1>;

/// δ(u, v): how far the surface lies behind its middle. A member is the coefficient of the monomial in its
/// name.
struct BackDepth {
  double u2 = 0.0, u4 = 0.0, v = 0.0, v2 = 0.0, v3 = 0.0, u2v = 0.0;

  bool flat() const { return u2 == 0.0 && u4 == 0.0 && v == 0.0 && v2 == 0.0 && v3 == 0.0 && u2v == 0.0; }
  double at(double at_u, double at_v) const {
    const double uu = at_u * at_u;
    return uu * (u2 + u4 * uu + u2v * at_v) + at_v * (v + at_v * (v2 + at_v * v3));
  }
  double by_u(double at_u, double at_v) const {
    return 2.0 * at_u * (u2 + 2.0 * u4 * at_u * at_u + u2v * at_v);
  }
  double by_v(double at_u, double at_v) const {
    return v + at_v * (2.0 * v2 + 3.0 * v3 * at_v) + u2v * at_u * at_u;
  }
};

struct BackSurface {
  BackDepth depth;                                      ///< in units of d
  double axis_x = 0.0;                                  ///< x of the middle of the region
  double axis_y = 0.0;                                  ///< y of the middle of the region
  Eigen::Vector2d half_size = Eigen::Vector2d::Ones();  ///< half width and height of the region
  double shape_sigma = 0.0;                             ///< σ_shape / d
  double bend_sigma = 0.0;                              ///< σ_κ d: people differ

  bool flat() const { return depth.flat(); }
  double u(const Eigen::Vector3d& ray) const { return (ray.x() - axis_x) / half_size.x(); }
  double v(const Eigen::Vector3d& ray) const { return (ray.y() - axis_y) / half_size.y(); }

  /// X_ref / d under the normalised reference point (x, y, 1).
  Eigen::Vector3d point(const Eigen::Vector3d& ray) const { return (1.0 + depth.at(u(ray), v(ray))) * ray; }

  /// How far each of the five shapes moves the point along the normal (0,0,1), one standard deviation.
  Vector5d departures(const Eigen::Vector3d& ray) const {
    const double at_u = u(ray), at_v = v(ray);
    Vector5d shapes;
    shapes << at_u, at_v, at_u * at_u - 1.0 / 3.0, at_u * at_v, at_v * at_v - 1.0 / 3.0;
    return shape_sigma * shapes;
  }

  /// How far an error of the curvature moves the point along its ray, one standard deviation.
  double departure_of_bend(const Eigen::Vector3d& ray) const {
    return bend_sigma * (ray.x() - axis_x) * (ray.x() - axis_x);
  }

  /// d point / d (x, y).
  Eigen::Matrix<double, 3, 2> derivative(const Eigen::Vector3d& ray) const {
    const double at_u = u(ray), at_v = v(ray), scale = 1.0 + depth.at(at_u, at_v);
    Eigen::Matrix<double, 3, 2> by_xy;
    by_xy.col(0) = scale * Eigen::Vector3d::UnitX() + depth.by_u(at_u, at_v) / half_size.x() * ray;
    by_xy.col(1) = scale * Eigen::Vector3d::UnitY() + depth.by_v(at_u, at_v) / half_size.y() * ray;
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
