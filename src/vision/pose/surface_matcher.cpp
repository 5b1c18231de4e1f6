#include "vision/pose/surface_matcher.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace heel {

SurfaceMatcher::SurfaceMatcher(std::span<const Eigen::Vector2d> reference_px,
                               const Eigen::Matrix3d& K_ref_inverse, const Eigen::Matrix3d& K_cur)
    : reference_px_(reference_px), K_ref_inverse_(K_ref_inverse), K_cur_(K_cur) {
  predicted_.reserve(reference_px.size());
  cur_from_ref_.reserve(reference_px.size());
}

void SurfaceMatcher::match(const BackSurface& surface, const FrontalMotion& motion, double limit_px,
                           TemplateMatcher& matcher, const FeatureGrid& frame, std::vector<PointPair>& out) {
  predict(surface, motion);
  out.clear();
  for (const Match& match : matcher.match_near(predicted_, frame)) {
    const auto ref = static_cast<std::size_t>(match.ref);
    const Eigen::Vector2d& cur_px = frame.undistorted_px()[static_cast<std::size_t>(match.cur)];
    const Eigen::Vector2d residual_px = predicted_[ref].px - cur_px;
    const Eigen::Matrix2d& D = cur_from_ref_[ref];
    const Eigen::Matrix2d S = Eigen::Matrix2d::Identity() + D * D.transpose();
    if (residual_px.dot(S.inverse() * residual_px) < limit_px * limit_px)
      out.push_back({reference_px_[ref], cur_px});
  }
}

/// Where the surface puts the features; those on the side turned away are not visible.
void SurfaceMatcher::predict(const BackSurface& surface, const FrontalMotion& motion) {
  const Eigen::Matrix3d KR = K_cur_ * motion.R_cur_from_ref;
  const Eigen::Vector3d Kt = K_cur_ * motion.t_over_d;
  predicted_.clear();
  cur_from_ref_.clear();
  for (const Eigen::Vector2d& px : reference_px_) {
    const Eigen::Vector3d ray = K_ref_inverse_ * px.homogeneous();
    const Eigen::Vector3d pixel = KR * surface.point(ray) + Kt;
    cur_from_ref_.push_back(image_derivative(surface, K_ref_inverse_, KR, Kt, ray));
    const double area = cur_from_ref_.back().determinant();
    predicted_.push_back({pixel.hnormalized(), pixel.z() > 0.0 && area > 0.0 ? std::sqrt(area) : 0.0});
  }
}

}  // namespace heel
