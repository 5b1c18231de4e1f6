#include "vision/pose/back_pose_selector.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "vision/pose/alternative_hypotheses.h"
#include "vision/pose/average_back.h"

namespace heel {
namespace {

// The plane is selected if it explains the frame this many times better than the curved surface.
constexpr double kPlaneAdvantage = 1.25;
// The odds of the curved surface are the advantage to the power −4: 2 to 5 at 1.25 times, 1 to 16 at twice.
constexpr double kAdvantageExponent = 4.0;
constexpr double kMinNoise_px = 0.3;  // smaller residuals do not make a fit better

/// How well a pose explains the frame: it is better with more pairs and with smaller residuals.
double explanation(std::size_t pairs, const FrontalPose& pose) {
  return static_cast<double>(pairs) / std::max(kMinNoise_px, pose.motion.noise_px);
}

FrontalPose with_patches(FrontalPose pose, const SurfacePose& refined) {
  pose.motion = refined.motion;
  pose.covariance = refined.covariance;
  pose.yaw_rad = yaw_of_rotation(refined.motion.R_cur_from_ref);
  pose.yaw_sigma_rad = yaw_sigma_rad(refined.motion.R_cur_from_ref, refined.covariance);
  pose.t_over_d_sigma = refined.covariance.diagonal().tail<3>().cwiseSqrt();
  return pose;
}

}  // namespace

BackPoseSelector::BackPoseSelector(const ShirtTemplate& shirt, const ReferenceView& reference,
                                   const CameraModel& camera, const VisionConfig& config)
    : K_ref_(reference.K),
      K_cur_(camera.K()),
      centre_px_(reference.centre_px),
      flat_(flat_surface(reference, config)),
      curved_(average_back(reference, config)),
      frontal_estimator_(reference.px.size()),
      surface_refiner_(reference.px, reference.K_inverse, frontal_estimator_),
      patch_refiner_(shirt, camera) {}

FrontalPose BackPoseSelector::estimate(const PlaneSolution& plane, TemplateMatcher& matcher,
                                       const FrameContent& frame, int patch_rounds) {
  FrontalProblem problem{plane.inliers, K_ref_, K_cur_, plane.H_cur_from_ref, centre_px_, flat_};
  FrontalPose of_plane = frontal_estimator_.estimate(problem, plane.motion);
  if (curved_.flat()) return of_plane;
  problem.surface = curved_;
  const CurvedSurfacePose of_curve = surface_refiner_.refine(
      problem, frontal_estimator_.estimate(problem, plane.motion), matcher, frame.features);
  const double advantage =
      explanation(plane.inliers.size(), of_plane) / explanation(of_curve.pairs.size(), of_curve.pose);
  if (!(advantage >= kPlaneAdvantage))
    return refined(curved_, of_curve.pairs, of_curve.pose, frame.view, patch_rounds);
  const AlternativeHypothesis curved{of_curve.pose.motion, std::pow(advantage, -kAdvantageExponent)};
  inflate_covariance({&curved, 1}, of_plane);
  return refined(flat_, plane.inliers, of_plane, frame.view, patch_rounds);
}

/// `pose` itself where too few patches are found.
FrontalPose BackPoseSelector::refined(const BackSurface& surface, std::span<const PointPair> pairs,
                                      const FrontalPose& pose, const FrameView& frame, int patch_rounds) {
  const std::optional<SurfacePose> refined =
      patch_refiner_.refine(frame, surface, pairs, pose.motion, patch_rounds);
  return refined ? with_patches(pose, *refined) : pose;
}

}  // namespace heel
