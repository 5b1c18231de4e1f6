#include "vision/pose/back_pose_selector.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vision/pose/alternative_hypotheses.h"

namespace heel {
namespace {

// So many times better the plane must explain what is seen to be it: a picture, or a board to try heel with.
constexpr double kFlatter = 1.25;
constexpr double kFlatness =
    4.0;  // then the odds of the curve are two in five, at twice as well one in sixteen
constexpr double kLeastNoise_px = 0.3;  // no fit is better for less

BackSurface flat_surface(const ReferenceView& reference, const VisionConfig& config) {
  const Eigen::Vector3d first = reference.K_inverse * reference.outline_px[0].homogeneous();
  const Eigen::Vector3d last = reference.K_inverse * reference.outline_px[2].homogeneous();
  BackSurface surface;
  surface.axis_x = 0.5 * (first.x() + last.x());
  surface.axis_y = 0.5 * (first.y() + last.y());
  surface.half_size = 0.5 * (last - first).head<2>();
  if (reference.distance_m > 0.0) surface.shape_sigma = config.back_shape_sigma_m / reference.distance_m;
  return surface;
}

/// How well a pose explains what is seen: by many pairs and little error.
double explained(std::size_t pairs, const FrontalPose& pose) {
  return static_cast<double>(pairs) / std::max(kLeastNoise_px, pose.motion.noise_px);
}

}  // namespace

BackPoseSelector::BackPoseSelector(const ReferenceView& reference, const Eigen::Matrix3d& K_cur,
                                   const VisionConfig& config)
    : K_ref_(reference.K),
      K_cur_(K_cur),
      centre_px_(reference.centre_px),
      flat_(flat_surface(reference, config)),
      curved_(flat_),
      frontal_estimator_(reference.px.size()),
      surface_refiner_(reference.px, reference.K_inverse, frontal_estimator_) {
  if (!(reference.distance_m > 0.0)) return;
  curved_.bend = config.back_curvature_1_m * reference.distance_m;
  curved_.bend_sigma = config.back_curvature_sigma_1_m * reference.distance_m;
}

FrontalPose BackPoseSelector::estimate(const PlaneSolution& seen, TemplateMatcher& matcher,
                                       const FeatureGrid& frame) {
  FrontalProblem problem{seen.inliers, K_ref_, K_cur_, seen.H_cur_from_ref, centre_px_, flat_};
  FrontalPose of_plane = frontal_estimator_.estimate(problem, seen.motion);
  if (curved_.bend == 0.0) return of_plane;
  problem.surface = curved_;
  const CurvedSurfacePose of_curve =
      surface_refiner_.refine(problem, frontal_estimator_.estimate(problem, seen.motion), matcher, frame);
  const double better = explained(seen.inliers.size(), of_plane) / explained(of_curve.pairs, of_curve.pose);
  if (!(better >= kFlatter)) return of_curve.pose;
  const AlternativeHypothesis curved{of_curve.pose.motion, std::pow(better, -kFlatness)};
  inflate_covariance({&curved, 1}, of_plane);
  return of_plane;
}

}  // namespace heel
