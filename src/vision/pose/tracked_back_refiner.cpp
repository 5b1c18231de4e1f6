#include "vision/pose/tracked_back_refiner.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "vision/homography/shape_plausibility.h"

namespace heel {
namespace {

constexpr int kStepsToMove = 4, kTrackingPatchRounds = 1;  // the start is nearly the pose
constexpr double kInlierNoise_px = 0.7;
// The inliers may lie on one facet and then hardly determine the turn; patches do.
constexpr double kFrameTurnSigma_rad = 0.01, kFramePlaceSigmaOverD = 0.5;
constexpr double kPairLimit_px = 5.0;

constexpr double kMinTrackedAgreement = 0.6;
// A homography explains a facet of a back at most so many times better than the surface explains the back. It
// fits better than the plane's pose: it has two unknowns more.
constexpr double kHomographyAdvantage = 1.6;
constexpr double kMinFitNoise_px = 0.3;  // smaller residuals do not make a fit better

/// How well a fit explains the frame. `squared_px2`: sum of its residuals' squares, of a noise of 1 px in
/// both images.
double explanation(std::size_t pairs, double squared_px2) {
  const double count = static_cast<double>(pairs);
  return count / std::max(kMinFitNoise_px, std::sqrt(squared_px2 / std::max(1.0, 2.0 * count - 6.0)));
}

double explanation_by_homography(const PlaneSolution& plane) {
  const Eigen::Matrix3d& H = plane.H_cur_from_ref;
  double squared_px2 = 0.0;
  for (const PointPair& pair : plane.inliers) {
    const double scale = local_scale(H, pair.ref_px);
    squared_px2 +=
        ((H * pair.ref_px.homogeneous()).hnormalized() - pair.cur_px).squaredNorm() / (1.0 + scale * scale);
  }
  return explanation(plane.inliers.size(), squared_px2);
}

}  // namespace

TrackedBackRefiner::TrackedBackRefiner(const ReferenceView& reference, const Eigen::Matrix3d& K_cur,
                                       SurfaceMatcher& surface_matcher, SurfacePoseRefiner& patch_refiner)
    : K_ref_inverse_(reference.K_inverse),
      K_cur_(K_cur),
      surface_matcher_(surface_matcher),
      patch_refiner_(patch_refiner),
      solver_(K_cur, reference.px.size()) {
  observations_.reserve(reference.px.size());
  pairs_.reserve(reference.px.size());
}

std::optional<BackPose> TrackedBackRefiner::refine(const BackSurface& surface, const FrontalMotion& last,
                                                   const PlaneSolution& plane, TemplateMatcher& matcher,
                                                   const FrameContent& frame) {
  const FrontalMotion start = last_motion_fitted_to_inliers(surface, last, plane.inliers);
  surface_matcher_.match(surface, start, kPairLimit_px, matcher, frame.features, pairs_);
  const std::optional<SurfacePose> pose =
      patch_refiner_.refine(frame.view, surface, pairs_, start, kTrackingPatchRounds);
  if (!pose || pose->agreement < kMinTrackedAgreement) return std::nullopt;
  if (explanation_by_homography(plane) > kHomographyAdvantage * explanation_by(surface, pose->motion))
    return std::nullopt;
  return BackPose{frontal_pose(*pose), pairs_.size()};
}

/// The last pose moved to where this frame's inliers are. It hardly turns between two frames.
FrontalMotion TrackedBackRefiner::last_motion_fitted_to_inliers(const BackSurface& surface,
                                                                const FrontalMotion& last,
                                                                std::span<const PointPair> inliers) {
  observations_.clear();
  for (const PointPair& pair : inliers)
    observations_.push_back({K_ref_inverse_ * pair.ref_px.homogeneous(), pair.cur_px,
                             kInlierNoise_px * kInlierNoise_px * Eigen::Matrix2d::Identity()});
  const MotionPrior prior{Eigen::Vector3d::Constant(kFrameTurnSigma_rad),
                          Eigen::Vector3d::Constant(kFramePlaceSigmaOverD)};
  return solver_.solve(surface, observations_, last, kStepsToMove, prior);
}

/// Of the pairs by the surface in its pose.
double TrackedBackRefiner::explanation_by(const BackSurface& surface, const FrontalMotion& motion) const {
  const Eigen::Matrix3d KR = K_cur_ * motion.R_cur_from_ref;
  const Eigen::Vector3d Kt = K_cur_ * motion.t_over_d;
  double squared_px2 = 0.0;
  for (const PointPair& pair : pairs_) {
    const Eigen::Vector3d ray = K_ref_inverse_ * pair.ref_px.homogeneous();
    const double area = std::abs(image_derivative(surface, K_ref_inverse_, KR, Kt, ray).determinant());
    squared_px2 += ((KR * surface.point(ray) + Kt).hnormalized() - pair.cur_px).squaredNorm() / (1.0 + area);
  }
  return explanation(pairs_.size(), squared_px2);
}

}  // namespace heel
