#include "vision/pose/plane_fitter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace heel {
namespace {

// The features of true inliers change size as the homography says; those of a chance fit change by any
// factor.
constexpr double kMaxScaleDisagreement = 1.5;
constexpr int kGuidedRounds = 2;
constexpr double kSettled_px = 1.0;  // of the guided matcher's radius of 8: another round would pair the same

RansacSettings ransac_settings(const VisionConfig& config) {
  RansacSettings settings;
  settings.inlier_px = config.inlier_px;
  settings.max_iterations = config.ransac_iterations;
  settings.precision = false;  // the pose's own is computed from the pose
  return settings;
}

}  // namespace

PlaneFitter::PlaneFitter(const ReferenceView& reference, const ShapeLimits& shape_limits,
                         const VisionConfig& config)
    : reference_(reference),
      shape_limits_(shape_limits),
      min_inliers_(config.min_inliers),
      min_certainty_(config.min_certainty),
      homography_estimator_(static_cast<int>(reference.px.size()), ransac_settings(config)) {}

PlaneFit PlaneFitter::fit(std::span<const Match> matches, const FeatureGrid& frame, PoseWorkspace& work) {
  return checked_shape(fit_homography(matches, frame, work), frame, work);
}

PlaneFit PlaneFitter::fit_guided(const PlaneFit& first, TemplateMatcher& matcher, const FeatureGrid& frame,
                                 PoseWorkspace& work) {
  PlaneFit fit = first;
  for (int round = 0; round < kGuidedRounds; ++round) {
    const std::span<const Match> matches = matcher.match_near(predict(fit.H_cur_from_ref, work), frame);
    mark(work.times, VisionStage::GuidedMatching);
    const PlaneFit next = fit_homography(matches, frame, work);
    if (next.reason == PoseReason::NoHomography) {
      fit.reason = next.reason;
      return fit;
    }
    const double moved_px = outline_moved_px(fit.H_cur_from_ref, next.H_cur_from_ref);
    fit = next;
    if (!fit.found()) return fit;
    if (moved_px < kSettled_px) break;
  }
  if (fit.certainty < min_certainty_) fit.reason = PoseReason::TooFewInliers;
  return checked_shape(fit, frame, work);
}

bool PlaneFitter::plausible(const Eigen::Matrix3d& H_cur_from_ref) const {
  return plausible_shape(H_cur_from_ref, reference_.outline_px, shape_limits_);
}

/// Without a homography nothing of an earlier fit in the work space is overwritten but its pairs.
PlaneFit PlaneFitter::fit_homography(std::span<const Match> matches, const FeatureGrid& frame,
                                     PoseWorkspace& work) {
  work.pairs.clear();
  for (const Match& match : matches)
    work.pairs.push_back({reference_.px[static_cast<std::size_t>(match.ref)],
                          frame.undistorted_px()[static_cast<std::size_t>(match.cur)]});
  const RobustHomography homography = homography_estimator_.estimate(work.pairs, work.inlier_mask);
  mark(work.times, VisionStage::Homography);
  if (homography.status != HomographyStatus::Ok) return {};

  work.inlier_matches.clear();
  work.inliers.clear();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (work.inlier_mask[i] == 0) continue;
    work.inlier_matches.push_back(matches[i]);
    work.inliers.push_back(work.pairs[i]);
  }
  PlaneFit fit;
  fit.reason = homography.inliers < min_inliers_ ? PoseReason::TooFewInliers : PoseReason::Found;
  fit.H_cur_from_ref = homography.H_cur_from_ref;
  fit.inlier_matches = work.inlier_matches;
  fit.inliers = work.inliers;
  fit.certainty = static_cast<double>(homography.inliers) / static_cast<double>(reference_.px.size());
  return fit;
}

PlaneFit PlaneFitter::checked_shape(PlaneFit fit, const FeatureGrid& frame, PoseWorkspace& work) const {
  if (fit.found() && !(plausible(fit.H_cur_from_ref) && feature_scales_agree(fit, frame, work)))
    fit.reason = PoseReason::ImplausibleShape;
  return fit;
}

/// By the median, the inliers' features have grown or shrunk as the homography says.
bool PlaneFitter::feature_scales_agree(const PlaneFit& fit, const FeatureGrid& frame,
                                       PoseWorkspace& work) const {
  work.scale_disagreement.clear();
  for (std::size_t i = 0; i < fit.inliers.size(); ++i) {
    const Match& match = fit.inlier_matches[i];
    const Feature& ref = reference_.set.features[static_cast<std::size_t>(match.ref)];
    const Feature& cur = frame.features().features[static_cast<std::size_t>(match.cur)];
    const double expected = local_scale(fit.H_cur_from_ref, fit.inliers[i].ref_px);
    work.scale_disagreement.push_back(
        std::abs(std::log(static_cast<double>(cur.sigma_px) / ref.sigma_px / expected)));
  }
  const auto median =
      work.scale_disagreement.begin() + static_cast<std::ptrdiff_t>(work.scale_disagreement.size() / 2);
  std::nth_element(work.scale_disagreement.begin(), median, work.scale_disagreement.end());
  return *median <= std::log(kMaxScaleDisagreement);
}

/// The largest distance between the outline's corners under the two homographies.
double PlaneFitter::outline_moved_px(const Eigen::Matrix3d& H_before, const Eigen::Matrix3d& H_after) const {
  double largest_px = 0.0;
  for (const Eigen::Vector2d& corner : reference_.outline_px)
    largest_px = std::max(largest_px, ((H_after * corner.homogeneous()).hnormalized() -
                                       (H_before * corner.homogeneous()).hnormalized())
                                          .norm());
  return largest_px;
}

std::span<const PredictedFeature> PlaneFitter::predict(const Eigen::Matrix3d& H_cur_from_ref,
                                                       PoseWorkspace& work) const {
  work.predicted.clear();
  for (const Eigen::Vector2d& px : reference_.px)
    work.predicted.push_back(
        {(H_cur_from_ref * px.homogeneous()).hnormalized(), local_scale(H_cur_from_ref, px)});
  return work.predicted;
}

}  // namespace heel
