#include "vision/pose/curved_surface_refiner.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace heel {
namespace {

constexpr std::size_t kMinPairs = 6;  // twice what six unknowns need
constexpr double kSettled_rad = 3e-3, kSettledOverD = 3e-3;

// Pairs and pose improve in turn: the minimum of pairs that are about to change is not needed.
constexpr int kRounds = 4, kStepsPerRound = 2;
// Limits of the whitened residual, whose noise is 1 px where features are placed as precisely as usual. The
// first pose may be off at the back's edges.
constexpr double kFirstLimit_px = 5.0, kLimit_px = 3.0;

// Few pairs, all on one facet, hardly determine the yaw: unless this share of the template's features fits,
// the whole range of yaw is tried.
constexpr double kSureShare = 0.3;
constexpr std::array kOtherYaws_rad{-1.0, -0.6, -0.2, 0.2, 0.6, 1.0};
constexpr std::size_t kMaxFits = 2 + kOtherYaws_rad.size();

// Fits whose yaws differ by less are the same. A fit with this much less support is e times less likely. By
// noise alone that would be a fifth of a pair, but folds, and which features happen to be found again, change
// the support by one or two.
constexpr double kSameYaw_rad = 0.1;
constexpr double kDoubtfulSupport = 1.5;

PlaneMotion as_start(const FrontalMotion& motion) {
  PlaneMotion start;
  start.R_cur_from_ref = motion.R_cur_from_ref;
  start.t_over_d = motion.t_over_d;
  return start;
}

bool settled(const FrontalMotion& before, const FrontalMotion& after) {
  // |R − R'| of a small rotation is √2 times its angle.
  return (after.R_cur_from_ref - before.R_cur_from_ref).norm() < std::sqrt(2.0) * kSettled_rad &&
         (after.t_over_d - before.t_over_d).norm() < kSettledOverD;
}

}  // namespace

CurvedSurfaceRefiner::CurvedSurfaceRefiner(std::span<const Eigen::Vector2d> reference_px,
                                           const Eigen::Matrix3d& K_ref_inverse,
                                           FrontalPoseEstimator& estimator, SurfaceMatcher& surface_matcher)
    : reference_px_(reference_px),
      K_ref_inverse_(K_ref_inverse),
      estimator_(estimator),
      surface_matcher_(surface_matcher) {
  fitting_.reserve(reference_px.size());
  best_fitting_.reserve(reference_px.size());
  fits_.reserve(kMaxFits);
  alternatives_.reserve(kMaxFits);
}

CurvedSurfacePose CurvedSurfaceRefiner::refine(const FrontalProblem& problem, const FrontalPose& start,
                                               TemplateMatcher& matcher, const FeatureGrid& frame) {
  Fit best{start.motion, -1.0, {}};
  fits_.clear();
  const auto try_from = [&](const FrontalMotion& motion) {
    fits_.push_back(fit_surface(problem, motion, matcher, frame));
    if (!(fits_.back().support > best.support)) return;
    best = fits_.back();
    std::swap(fitting_, best_fitting_);  // the next fit must not overwrite the pairs of the best
  };
  try_from(start.motion);
  if (!settled(start.motion, start.other)) try_from(start.other);
  if (best.support < kSureShare * static_cast<double>(reference_px_.size())) {
    const double yaw_rad = yaw_of_rotation(start.motion.R_cur_from_ref);
    for (const double other_yaw_rad : kOtherYaws_rad)
      try_from(turned(problem, start.motion, other_yaw_rad - yaw_rad));
  }
  if (best.support < 0.0) return {start, {}};

  FrontalProblem of_surface = problem;
  of_surface.pairs = best.pairs;
  CurvedSurfacePose answer{estimator_.estimate(of_surface, as_start(best.motion)), best.pairs};
  inflate_covariance(alternatives_to(answer.pose.motion, fits_, best.support), answer.pose);
  return answer;
}

CurvedSurfaceRefiner::Fit CurvedSurfaceRefiner::fit_surface(FrontalProblem problem,
                                                            const FrontalMotion& start,
                                                            TemplateMatcher& matcher,
                                                            const FeatureGrid& frame) {
  Fit fit{start, -1.0, {}};
  for (int round = 0; round < kRounds; ++round) {
    const FrontalMotion before = fit.motion;
    surface_matcher_.match(problem.surface, before, round == 0 ? kFirstLimit_px : kLimit_px, matcher, frame,
                           fitting_);
    fit.pairs = fitting_;
    if (fit.pairs.size() < kMinPairs) return {start, -1.0, {}};
    problem.pairs = fit.pairs;
    fit.motion = estimator_.refine(problem, as_start(before), kStepsPerRound);
    if (round > 0 && settled(before, fit.motion)) break;
  }
  fit.support = static_cast<double>(fit.pairs.size()) - fit.motion.cost_px2 / (kLimit_px * kLimit_px);
  return fit;
}

/// The target turned by `angle_rad` to the image's right about the vertical axis through the middle of the
/// pairs.
FrontalMotion CurvedSurfaceRefiner::turned(const FrontalProblem& problem, const FrontalMotion& motion,
                                           double angle_rad) const {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const PointPair& pair : problem.pairs)
    middle += problem.surface.point(K_ref_inverse_ * pair.ref_px.homogeneous());
  middle /= static_cast<double>(problem.pairs.size());
  FrontalMotion turned = motion;
  turned.R_cur_from_ref =
      Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix() * motion.R_cur_from_ref;
  turned.t_over_d = motion.t_over_d + (motion.R_cur_from_ref - turned.R_cur_from_ref) * middle;
  return turned;
}

/// Of fits with the same yaw the best counts. Sorts `fits`.
std::span<const AlternativeHypothesis> CurvedSurfaceRefiner::alternatives_to(const FrontalMotion& chosen,
                                                                             std::span<Fit> fits,
                                                                             double best_support) {
  std::sort(fits.begin(), fits.end(), [](const Fit& a, const Fit& b) { return a.support > b.support; });
  alternatives_.clear();
  for (const Fit& fit : fits) {
    if (fit.support <= 0.0) break;
    const auto same_yaw = [&](const FrontalMotion& other) {
      return yaw_difference_rad(fit.motion, other) < kSameYaw_rad;
    };
    if (same_yaw(chosen) ||
        std::any_of(alternatives_.begin(), alternatives_.end(),
                    [&](const AlternativeHypothesis& known) { return same_yaw(known.motion); }))
      continue;
    alternatives_.push_back({fit.motion, std::exp((fit.support - best_support) / kDoubtfulSupport)});
  }
  return alternatives_;
}

}  // namespace heel
