#include "surface_follower.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace heel {
namespace {

constexpr std::size_t kLeastPairs = 6;  // twice what six unknowns need
constexpr double kSettledRad = 1e-3, kSettledOverD = 1e-3;

constexpr int kRounds = 4;
// Of the whitened residual, whose noise is 1 px where features are as well placed as usual. The first pose
// may be off at the back's edges.
constexpr double kFirstLimitPx = 5.0, kLimitPx = 3.0;

PlaneMotion as_start(const FrontalMotion& motion) {
  PlaneMotion start;
  start.R_cur_from_ref = motion.R_cur_from_ref;
  start.t_over_d = motion.t_over_d;
  return start;
}

bool settled(const FrontalMotion& before, const FrontalMotion& after) {
  // |R − R'|, of a small turn, is √2 times its angle.
  return (after.R_cur_from_ref - before.R_cur_from_ref).norm() < std::sqrt(2.0) * kSettledRad &&
         (after.t_over_d - before.t_over_d).norm() < kSettledOverD;
}

}  // namespace

SurfaceFollower::SurfaceFollower(const ReferenceFeatures& reference, FrontalPoseEstimator& estimator)
    : reference_(reference), estimator_(estimator), predicted_(reference.px.size()) {
  matches_.reserve(reference.px.size());
  fitting_.reserve(reference.px.size());
  best_fitting_.reserve(reference.px.size());
}

/// Where the surface puts the features, those on the side turned away excepted.
void SurfaceFollower::predict(const FrontalProblem& problem, const FrontalMotion& motion) {
  const Eigen::Matrix3d KR = problem.K_cur * motion.R_cur_from_ref;
  const Eigen::Vector3d Kt = problem.K_cur * motion.t_over_d;
  for (std::size_t i = 0; i < predicted_.size(); ++i) {
    const Eigen::Vector3d ray = reference_.K_inverse * reference_.px[i].homogeneous();
    const Eigen::Vector3d pixel = KR * problem.surface.point(ray) + Kt;
    const double area = image_derivative(problem.surface, reference_.K_inverse, KR, Kt, ray).determinant();
    predicted_[i] = {pixel.hnormalized(), pixel.z() > 0.0 && area > 0.0 ? std::sqrt(area) : 0.0};
  }
}

void SurfaceFollower::keep_what_fits(const FrontalProblem& problem, const FrontalMotion& motion,
                                     double limit_px, std::span<const Eigen::Vector2d> frame_px) {
  const Eigen::Matrix3d KR = problem.K_cur * motion.R_cur_from_ref;
  const Eigen::Vector3d Kt = problem.K_cur * motion.t_over_d;
  fitting_.clear();
  for (const Match& match : matches_) {
    const auto ref = static_cast<std::size_t>(match.ref), cur = static_cast<std::size_t>(match.cur);
    const Eigen::Vector3d ray = reference_.K_inverse * reference_.px[ref].homogeneous();
    const Eigen::Vector2d off = predicted_[ref].px - frame_px[cur];
    const Eigen::Matrix2d D = image_derivative(problem.surface, reference_.K_inverse, KR, Kt, ray);
    const Eigen::Matrix2d S = Eigen::Matrix2d::Identity() + D * D.transpose();
    if (off.dot(S.inverse() * off) < limit_px * limit_px)
      fitting_.push_back({reference_.px[ref], frame_px[cur]});
  }
}

SurfaceFollower::Fit SurfaceFollower::improve(FrontalProblem problem, const FrontalMotion& start,
                                              GuidedMatcher& matcher,
                                              std::span<const Eigen::Vector2d> frame_px) {
  Fit fit{start, -1.0};
  for (int round = 0; round < kRounds; ++round) {
    const FrontalMotion before = fit.motion;
    predict(problem, before);
    matcher.match(predicted_, reference_.features, matches_);
    keep_what_fits(problem, before, round == 0 ? kFirstLimitPx : kLimitPx, frame_px);
    if (fitting_.size() < kLeastPairs) return {start, -1.0};
    problem.pairs = fitting_;
    fit.motion = estimator_.refine(problem, as_start(before));
    if (round > 0 && settled(before, fit.motion)) break;
  }
  fit.support = static_cast<double>(fitting_.size()) - fit.motion.cost_px2 / (kLimitPx * kLimitPx);
  return fit;
}

FrontalPose SurfaceFollower::follow(const FrontalProblem& problem, const FrontalPose& start,
                                    GuidedMatcher& matcher, std::span<const Eigen::Vector2d> frame_px) {
  Fit best = improve(problem, start.motion, matcher, frame_px);
  best_fitting_.assign(fitting_.begin(), fitting_.end());
  const Fit other = improve(problem, start.other, matcher, frame_px);
  if (other.support > best.support) {
    best = other;
    std::swap(fitting_, best_fitting_);
  }
  if (best.support < 0.0) {
    best_fitting_.clear();
    return start;
  }
  FrontalProblem of_surface = problem;
  of_surface.pairs = best_fitting_;
  return estimator_.estimate(of_surface, as_start(best.motion));
}

}  // namespace heel
