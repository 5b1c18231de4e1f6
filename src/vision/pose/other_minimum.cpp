#include "vision/pose/other_minimum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "vision/pose/alternative_hypotheses.h"

namespace heel {
namespace {

// Minima nearer than this are one.
constexpr double kSame_rad = 0.1;
// Nearer to the mirror image than this, the minima to either side are searched from here.
constexpr double kNearlyFrontal_rad = 0.25;
constexpr std::array kToEitherSide_rad{-0.25, 0.25};
// One round of the patches shows which starts lead nowhere: their score is less than this share.
constexpr double kPromising = 0.75;
constexpr int kFurtherRounds = 1;
// The features support the pose that was found first: the other one is chosen if its score is larger by this.
constexpr double kBetter = 1.05;
// The odds of the other one fall by e with each such share of the score that it lacks. Measured on pictures
// with truth: of those that lack less than 5 % a fifth are the true ones, of those that lack 5 to 10 %, 2 %.
constexpr double kScoreShareOfOdds = 0.015;

/// Nothing where no other one explains the frame.
std::optional<SurfacePose> other_minimum(SurfacePoseRefiner& patch_refiner, const FrameView& frame,
                                         const FrontalProblem& geometry, const SurfacePose& pose) {
  std::optional<SurfacePose> best;
  const auto search_from = [&](const FrontalMotion& start) {
    const std::optional<SurfacePose> found = patch_refiner.refine(frame, geometry.surface, {}, start, 1);
    if (found && (!best || found->score > best->score)) best = found;
  };
  const PlaneMotion mirrored = mirrored_motion(geometry, pose.motion);
  FrontalMotion start;
  start.R_cur_from_ref = mirrored.R_cur_from_ref;
  start.t_over_d = mirrored.t_over_d;
  if (yaw_difference_rad(start, pose.motion) > kNearlyFrontal_rad) {
    search_from(start);
  } else {
    for (const double turn_rad : kToEitherSide_rad)
      search_from(turned(pose.motion, turn_rad, geometry.surface));
  }
  if (!best || best->score < kPromising * pose.score) return std::nullopt;
  best = patch_refiner.refine(frame, geometry.surface, {}, best->motion, kFurtherRounds);
  if (best && yaw_difference_rad(best->motion, pose.motion) < kSame_rad) best.reset();
  return best;
}

}  // namespace

FrontalPose better_minimum(SurfacePoseRefiner& patch_refiner, const FrameView& frame,
                           const FrontalProblem& geometry, const SurfacePose& pose) {
  const std::optional<SurfacePose> other = other_minimum(patch_refiner, frame, geometry, pose);
  if (!other) return frontal_pose(pose);

  const bool better = other->score > kBetter * pose.score;
  return better ? weighed(*other, pose) : weighed(pose, *other);
}

FrontalPose weighed(const SurfacePose& chosen, const SurfacePose& rejected) {
  FrontalPose frontal = frontal_pose(chosen);
  frontal.other = rejected.motion;
  const double lacks = 1.0 - rejected.score / std::max(1e-9, chosen.score);
  const AlternativeHypothesis alternative{rejected.motion,
                                          std::exp(-std::max(0.0, lacks) / kScoreShareOfOdds)};
  inflate_covariance({&alternative, 1}, frontal);
  return frontal;
}

}  // namespace heel
