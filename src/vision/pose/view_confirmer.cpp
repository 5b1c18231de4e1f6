#include "vision/pose/view_confirmer.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "heel/motion.h"

namespace heel {
namespace {

constexpr std::size_t kMinMatches = 5;
constexpr double kMinCentreDepth = 0.05;  // of the middle of the back, in units of d
constexpr double kPairFits = 0.25;        // least weight of a pair that fits

/// The radius of a round's matching, as a share of the back's longer side and at least, and the pairs' noise.
/// The candidate may be off by an eighth of the back.
struct Round {
  double radius_share, min_radius_px, noise_px;
  int steps;
};
constexpr std::array<Round, 5> kRounds{{{0.12, 6.0, 2.0, 5},
                                        {0.06, 5.0, 1.0, 5},
                                        {0.04, 4.0, 1.0, 5},
                                        {0.04, 4.0, 1.0, 5},
                                        {0.04, 4.0, 1.0, 10}}};
constexpr double kTurnSigma_rad = 0.4, kTiltSigma_rad = 0.1, kPlaceShare = 0.3;  // of a round's start

std::size_t largest(std::span<const TemplateView> views) {
  std::size_t features = 0;
  for (const TemplateView& view : views) features = std::max(features, view.set.features.size());
  return features;
}

}  // namespace

ViewConfirmer::ViewConfirmer(std::span<const TemplateView> views, const BackSurface& surface,
                             const CameraModel& reference_camera, const CameraModel& current_camera,
                             int max_frame_features)
    : views_(views),
      surface_(surface),
      K_ref_inverse_(reference_camera.K().inverse()),
      K_cur_(current_camera.K()),
      focal_ratio_(
          std::sqrt(current_camera.fx * current_camera.fy / (reference_camera.fx * reference_camera.fy))),
      region_side_px_(2.0 * std::max(surface.half_size.x() * reference_camera.fx,
                                     surface.half_size.y() * reference_camera.fy)),
      matcher_(max_frame_features, GuidedMatchSettings{}),
      solver_(K_cur_, largest(views)) {
  predicted_.reserve(largest(views));
  matches_.reserve(largest(views));
  observations_.reserve(largest(views));
  pairs_.reserve(largest(views));
}

std::optional<ConfirmedView> ViewConfirmer::confirm(const FrontalMotion& candidate, const FeatureGrid& frame,
                                                    double magnification) {
  ConfirmedView confirmed{candidate, {}, 0};
  const TemplateView* view = nullptr;
  for (const Round& round : kRounds) {
    const Eigen::Matrix3d& R = confirmed.motion.R_cur_from_ref;
    const double depth =
        (R * Eigen::Vector3d(surface_.axis_x, surface_.axis_y, 1.0) + confirmed.motion.t_over_d).z();
    if (!(depth > kMinCentreDepth)) return std::nullopt;
    const double scale = focal_ratio_ / depth;
    view = &nearest_view(views_, yaw_of_rotation(R), magnification * scale);
    const double radius_px = std::max(round.min_radius_px, round.radius_share * region_side_px_ * scale);
    matcher_.match(view->set, predict(*view, confirmed.motion), frame, radius_px, matches_);
    if (matches_.size() < kMinMatches) return std::nullopt;
    observations_.clear();
    for (const Match& match : matches_)
      observations_.push_back(
          {K_ref_inverse_ * view->ref_px[static_cast<std::size_t>(match.ref)].homogeneous(),
           frame.undistorted_px()[static_cast<std::size_t>(match.cur)],
           round.noise_px * round.noise_px * Eigen::Matrix2d::Identity()});
    const MotionPrior prior{{kTiltSigma_rad, kTurnSigma_rad, kTiltSigma_rad},
                            Eigen::Vector3d::Constant(kPlaceShare * depth)};
    confirmed.motion = solver_.solve(surface_, observations_, confirmed.motion, round.steps, prior);
    if (!confirmed.motion.t_over_d.allFinite()) return std::nullopt;
  }
  pairs_.clear();
  for (std::size_t i = 0; i < matches_.size(); ++i)
    if (solver_.weight(i) > kPairFits)
      pairs_.push_back({view->ref_px[static_cast<std::size_t>(matches_[i].ref)], observations_[i].cur_px});
  confirmed.pairs = pairs_;
  confirmed.view_features = view->set.features.size();
  return confirmed;
}

/// Where the pose puts the view's features, and how much larger than in the view.
std::span<const PredictedFeature> ViewConfirmer::predict(const TemplateView& view,
                                                         const FrontalMotion& motion) {
  const Eigen::Matrix3d KR = K_cur_ * motion.R_cur_from_ref;
  const Eigen::Vector3d Kt = K_cur_ * motion.t_over_d;
  predicted_.clear();
  for (std::size_t i = 0; i < view.ref_px.size(); ++i) {
    const Eigen::Vector3d ray = K_ref_inverse_ * view.ref_px[i].homogeneous();
    const Eigen::Vector3d pixel = KR * surface_.point(ray) + Kt;
    const double area = image_derivative(surface_, K_ref_inverse_, KR, Kt, ray).determinant();
    const bool visible = pixel.z() > 0.0 && area > 0.0;
    predicted_.push_back({pixel.hnormalized(), visible ? std::sqrt(area) / view.local_scale[i] : 0.0});
  }
  return predicted_;
}

}  // namespace heel
