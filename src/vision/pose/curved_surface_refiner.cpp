#include "vision/pose/curved_surface_refiner.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace heel {
namespace {

constexpr std::size_t kLeastPairs = 6;  // twice what six unknowns need
constexpr double kSettled_rad = 3e-3, kSettledOverD = 3e-3;

// Pairs and pose improve by turns: no use in descending to the minimum of pairs that are to change.
constexpr int kRounds = 4, kStepsInRound = 2;
// Of the whitened residual, whose noise is 1 px where features are as well placed as usual. The first pose
// may be off at the back's edges.
constexpr double kFirstLimit_px = 5.0, kLimit_px = 3.0;

// Few pairs, of one facet, hardly tell how the back is turned: unless this share of the template's features
// fits, the whole range is tried.
constexpr double kSureShare = 0.3;
constexpr std::array kOtherYaws_rad{-1.0, -0.6, -0.2, 0.2, 0.6, 1.0};
constexpr std::size_t kMostFits = 2 + kOtherYaws_rad.size();

// Fits whose yaws differ by less are the same. One that has so much less support is e times less likely: by
// noise alone it were a fifth of a pair, but folds, and which features happen to be found again, decide over
// one or two.
constexpr double kSameYaw_rad = 0.1;
constexpr double kDoubtfulSupport = 1.5;

PlaneMotion as_start(const FrontalMotion& motion) {
  PlaneMotion start;
  start.R_cur_from_ref = motion.R_cur_from_ref;
  start.t_over_d = motion.t_over_d;
  return start;
}

bool settled(const FrontalMotion& before, const FrontalMotion& after) {
  // |R − R'|, of a small turn, is √2 times its angle.
  return (after.R_cur_from_ref - before.R_cur_from_ref).norm() < std::sqrt(2.0) * kSettled_rad &&
         (after.t_over_d - before.t_over_d).norm() < kSettledOverD;
}

}  // namespace

CurvedSurfaceRefiner::CurvedSurfaceRefiner(const ReferenceFeatures& reference,
                                           FrontalPoseEstimator& estimator)
    : reference_(reference), estimator_(estimator), predicted_(reference.px.size()) {
  matches_.reserve(reference.px.size());
  fitting_.reserve(reference.px.size());
  best_fitting_.reserve(reference.px.size());
  fits_.reserve(kMostFits);
  alternatives_.reserve(kMostFits);
}

/// Where the surface puts the features, those on the side turned away excepted.
void CurvedSurfaceRefiner::predict(const FrontalProblem& problem, const FrontalMotion& motion) {
  const Eigen::Matrix3d KR = problem.K_cur * motion.R_cur_from_ref;
  const Eigen::Vector3d Kt = problem.K_cur * motion.t_over_d;
  for (std::size_t i = 0; i < predicted_.size(); ++i) {
    const Eigen::Vector3d ray = reference_.K_inverse * reference_.px[i].homogeneous();
    const Eigen::Vector3d pixel = KR * problem.surface.point(ray) + Kt;
    const double area = image_derivative(problem.surface, reference_.K_inverse, KR, Kt, ray).determinant();
    predicted_[i] = {pixel.hnormalized(), pixel.z() > 0.0 && area > 0.0 ? std::sqrt(area) : 0.0};
  }
}

void CurvedSurfaceRefiner::keep_what_fits(const FrontalProblem& problem, const FrontalMotion& motion,
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

CurvedSurfaceRefiner::Fit CurvedSurfaceRefiner::improve(FrontalProblem problem, const FrontalMotion& start,
                                                        GuidedMatcher& matcher,
                                                        std::span<const Eigen::Vector2d> frame_px) {
  Fit fit{start, -1.0};
  for (int round = 0; round < kRounds; ++round) {
    const FrontalMotion before = fit.motion;
    predict(problem, before);
    matcher.match(predicted_, reference_.features, matches_);
    keep_what_fits(problem, before, round == 0 ? kFirstLimit_px : kLimit_px, frame_px);
    if (fitting_.size() < kLeastPairs) return {start, -1.0};
    problem.pairs = fitting_;
    fit.motion = estimator_.refine(problem, as_start(before), kStepsInRound);
    if (round > 0 && settled(before, fit.motion)) break;
  }
  fit.support = static_cast<double>(fitting_.size()) - fit.motion.cost_px2 / (kLimit_px * kLimit_px);
  return fit;
}

/// The target turned by `angle_rad` to the image's right about the upright axis through what the pairs show.
FrontalMotion CurvedSurfaceRefiner::turned(const FrontalProblem& problem, const FrontalMotion& motion,
                                           double angle_rad) const {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const PointPair& pair : problem.pairs)
    middle += problem.surface.point(reference_.K_inverse * pair.ref_px.homogeneous());
  middle /= static_cast<double>(problem.pairs.size());
  FrontalMotion turned = motion;
  turned.R_cur_from_ref =
      Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitY()).toRotationMatrix() * motion.R_cur_from_ref;
  turned.t_over_d = motion.t_over_d + (motion.R_cur_from_ref - turned.R_cur_from_ref) * middle;
  return turned;
}

void CurvedSurfaceRefiner::attempt(const FrontalProblem& problem, const FrontalMotion& start,
                                   GuidedMatcher& matcher, std::span<const Eigen::Vector2d> frame_px) {
  fits_.push_back(improve(problem, start, matcher, frame_px));
  if (!(fits_.back().support > best_.support)) return;
  best_ = fits_.back();
  std::swap(fitting_, best_fitting_);
}

/// Of fits with the same yaw the best counts.
void CurvedSurfaceRefiner::inflate_covariance_by_other_fits(FrontalPose& pose) {
  std::sort(fits_.begin(), fits_.end(), [](const Fit& a, const Fit& b) { return a.support > b.support; });
  alternatives_.clear();
  for (const Fit& fit : fits_) {
    if (fit.support <= 0.0) break;
    const auto same = [&](const FrontalMotion& other) {
      return yaw_between(fit.motion, other) < kSameYaw_rad;
    };
    if (same(pose.motion) ||
        std::any_of(alternatives_.begin(), alternatives_.end(),
                    [&](const AlternativeHypothesis& rival) { return same(rival.motion); }))
      continue;
    alternatives_.push_back({fit.motion, std::exp((fit.support - best_.support) / kDoubtfulSupport)});
  }
  inflate_covariance(alternatives_, pose);
}

FrontalPose CurvedSurfaceRefiner::follow(const FrontalProblem& problem, const FrontalPose& start,
                                         GuidedMatcher& matcher, std::span<const Eigen::Vector2d> frame_px) {
  best_ = {start.motion, -1.0};
  best_fitting_.clear();
  fits_.clear();
  attempt(problem, start.motion, matcher, frame_px);
  if (!settled(start.motion, start.other)) attempt(problem, start.other, matcher, frame_px);
  if (best_.support < kSureShare * static_cast<double>(reference_.px.size())) {
    const double yaw_rad = yaw_of_rotation(start.motion.R_cur_from_ref);
    for (const double other_yaw_rad : kOtherYaws_rad)
      attempt(problem, turned(problem, start.motion, other_yaw_rad - yaw_rad), matcher, frame_px);
  }
  if (best_.support < 0.0) {
    best_fitting_.clear();
    return start;
  }
  FrontalProblem of_surface = problem;
  of_surface.pairs = best_fitting_;
  FrontalPose pose = estimator_.estimate(of_surface, as_start(best_.motion));
  inflate_covariance_by_other_fits(pose);
  return pose;
}

}  // namespace heel
