#include "vision/pose/back_pose_selector.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "vision/pose/alternative_hypotheses.h"
#include "vision/pose/average_back.h"
#include "vision/pose/other_minimum.h"

namespace heel {
namespace {

// Cloth that hangs otherwise than when it was taught has a second minimum about so far away.
constexpr std::array kTurns_rad{-0.25, 0.25};

// Patches are aligned and the pose is solved once: the start is nearly the pose.
constexpr int kPatchRoundsAfterLast = 1;

// The plane may be selected if it explains the frame this many times better than the curved surface.
constexpr double kPlaneAdvantage = 1.25;
// On a board that is one, patches lie nearer than this share of their distance on the curved surface. The
// surface may turn and stretch so that nearly as many patches are in place, but never as precisely.
constexpr double kBoardResidual = 0.7;
// Without patches the odds of the curved surface are the advantage to the power −4: 2 to 5 at 1.25 times, 1
// to 16 at twice.
constexpr double kAdvantageExponent = 4.0;
constexpr double kMinNoise_px = 0.3;  // smaller residuals do not make a fit better

/// How well a pose explains the frame: it is better with more pairs and with smaller residuals.
double explanation(std::size_t pairs, const FrontalPose& pose) {
  return static_cast<double>(pairs) / std::max(kMinNoise_px, pose.motion.noise_px);
}

}  // namespace

BackPoseSelector::BackPoseSelector(const ReferenceView& reference, const Eigen::Matrix3d& K_cur,
                                   const VisionConfig& config, SurfacePoseRefiner& patch_refiner)
    : K_ref_(reference.K),
      K_cur_(K_cur),
      centre_px_(reference.centre_px),
      flat_(flat_surface(reference, config)),
      curved_(average_back(reference, config)),
      frontal_estimator_(reference.px.size()),
      surface_matcher_(reference.px, reference.K_inverse, K_cur),
      surface_refiner_(reference.px, reference.K_inverse, frontal_estimator_, surface_matcher_),
      patch_refiner_(patch_refiner),
      tracked_refiner_(reference, K_cur, surface_matcher_, patch_refiner) {}

BackPose BackPoseSelector::estimate(const PlaneSolution& plane, TemplateMatcher& matcher,
                                    const FrameContent& frame, int patch_rounds) {
  FrontalProblem problem{plane.inliers, K_ref_, K_cur_, plane.H_cur_from_ref, centre_px_, flat_};
  FrontalPose of_plane = frontal_estimator_.estimate(problem, plane.motion);
  if (curved_.flat()) return {of_plane, plane.inliers.size()};
  problem.surface = curved_;
  const CurvedSurfacePose of_curve = surface_refiner_.refine(
      problem, frontal_estimator_.estimate(problem, plane.motion), matcher, frame.features);
  std::optional<SurfacePose> curve =
      patch_refiner_.refine(frame.view, curved_, of_curve.pairs, of_curve.pose.motion, patch_rounds);
  if (curve) curve = patch_refiner_.refine_turned(frame.view, curved_, *curve, kTurns_rad, patch_rounds);
  const double advantage =
      explanation(plane.inliers.size(), of_plane) / explanation(of_curve.pairs.size(), of_curve.pose);
  const auto by_patches = [&] { return better_minimum(patch_refiner_, frame.view, problem, *curve); };
  if (!(advantage >= kPlaneAdvantage)) return {curve ? by_patches() : of_curve.pose, of_curve.pairs.size()};

  const std::optional<SurfacePose> flat =
      patch_refiner_.refine(frame.view, flat_, plane.inliers, of_plane.motion, patch_rounds);
  if (curve && !(flat && flat->residual_px < kBoardResidual * curve->residual_px))
    return {by_patches(), of_curve.pairs.size()};
  if (flat) return {frontal_pose(*flat), plane.inliers.size()};
  const AlternativeHypothesis curved{of_curve.pose.motion, std::pow(advantage, -kAdvantageExponent)};
  inflate_covariance({&curved, 1}, of_plane);
  return {of_plane, plane.inliers.size()};
}

BackPose BackPoseSelector::estimate_next(const FrontalMotion& last, const PlaneSolution& plane,
                                         TemplateMatcher& matcher, const FrameContent& frame) {
  if (!curved_.flat())
    if (const std::optional<BackPose> tracked = tracked_refiner_.refine(curved_, last, plane, matcher, frame))
      return *tracked;
  return estimate(plane, matcher, frame, kPatchRoundsAfterLast);
}

}  // namespace heel
