// One frame's way through, in the order of M. Burke and W. Brink, "Estimating Target Orientation with a
// Single Camera for Use in a Human-Following Robot" (PRASA 2010); see Impl::estimate at the end.
#include "heel/pose_estimator.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "heel/homography.h"
#include "heel/matching.h"
#include "heel/motion.h"
#include "vision/homography/shape_plausibility.h"
#include "vision/matching/guided_matcher.h"
#include "vision/pose/back_pose_selector.h"
#include "vision/template/reference_view.h"

namespace heel {
namespace {

// A plane turned by 75° loses half its linear size (√cos 75°): features and outline shrink by that much
// beside what the distance does.
constexpr double kTiltShrink = 0.5;
constexpr double kScaleMargin = 1.2;  // the template's distance is measured by hand, a back is not flat
// Inliers' features change size as the homography says; those of a fit by chance change anyhow.
constexpr double kMaxScaleDisagreement = 1.5;
constexpr int kGuidedRounds = 2;
constexpr double kSettled_px = 1.0;  // of the guide's radius of 8: the next round would pair the same
// Round the expected view: what a homography found from few pairs is off at the outline, by share of its
// size; and how far features' scales lie from what it predicts, with what the target may come nearer in a
// second.
constexpr double kViewMargin = 0.1;
constexpr double kViewScaleMargin = 1.3;
constexpr double kApproach_1_s = 1.0;
// A shirt smaller than this share of its template shows few of the template's features as large as the
// smallest filter: then it is looked at upsample. So many pairs, a guess as yet, are worth a second look.
constexpr double kSmall = 0.8;
constexpr std::uint32_t kMinPairsForUpsampling = 5;

/// Smallest and largest magnification of the template for which the target is looked for.
struct ScaleRange {
  double min = 1.0, max = 1.0;
};

ScaleRange magnification(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config) {
  require_camera(camera, "current");
  const double focal_ratio = std::sqrt((camera.fx * camera.fy) / (shirt.camera.fx * shirt.camera.fy));
  // Without a distance all that is known is that the template was taught somewhere in the same range.
  const double nearest_ref = shirt.distance_m > 0.0 ? shirt.distance_m : config.distance_min_m;
  const double farthest_ref = shirt.distance_m > 0.0 ? shirt.distance_m : config.distance_max_m;
  return {focal_ratio * nearest_ref / config.distance_max_m,
          focal_ratio * farthest_ref / config.distance_min_m};
}

FeatureSettings frame_feature_settings(const ShirtTemplate& shirt, const FeatureSet& reference,
                                       const ScaleRange& range, const VisionConfig& config) {
  FeatureSettings settings;
  settings.octaves = config.octaves;
  settings.max_features = config.max_features;
  settings.oriented = shirt.oriented;
  float smallest = reference.features.front().sigma_px, largest = smallest;
  for (const Feature& feature : reference.features) {
    smallest = std::min(smallest, feature.sigma_px);
    largest = std::max(largest, feature.sigma_px);
  }
  settings.sigma_min_px = static_cast<float>(smallest * range.min * kTiltShrink);
  settings.sigma_max_px = static_cast<float>(largest * range.max * kScaleMargin);
  return settings;
}

RansacSettings ransac_settings(const VisionConfig& config) {
  RansacSettings settings;
  settings.inlier_px = config.inlier_px;
  settings.max_iterations = config.ransac_iterations;
  settings.precision = false;  // the pose has its own
  return settings;
}

Eigen::Vector2d undistorted(const CameraModel& camera, const Feature& feature) {
  return camera.undistort_px({static_cast<double>(feature.x_px), static_cast<double>(feature.y_px)});
}

}  // namespace

struct PoseEstimator::Impl {
  Impl(const ShirtTemplate& shirt, const CameraModel& current_camera, const VisionConfig& given);

  void make_pairs(const std::vector<Match>& from);
  PoseEstimate estimate(const FrameView& frame, const ExpectedView& search);
  ExpectedView expected_view(const Eigen::Matrix3d& H_cur_from_ref, double dt_s) const;
  bool needs_upsampled_pass(const PoseEstimate& pose) const;
  PoseReason find_pairs(const FrameView& frame, const ExpectedView& search, PoseEstimate& pose);
  PoseReason find_homography(PoseEstimate& pose);
  PoseReason check_shape();
  PoseReason match_again(PoseEstimate& pose);
  PoseReason find_motion(PoseEstimate& pose);
  double moved_px(const Eigen::Matrix3d& guide) const;
  void predict_from_homography();

  bool feature_scales_agree();
  bool is_small(const Eigen::Matrix3d& H_cur_from_ref) const;

  CameraModel camera;
  VisionConfig config;
  ReferenceView reference;
  Eigen::Matrix3d K_cur, K_cur_inverse;
  ScaleRange range;
  ShapeLimits shape_limits;
  ExpectedView anywhere;  // every size at which the robot may follow

  // The stages, and what travels between them.
  FeatureExtractor extractor;
  Matcher matcher;
  GuidedMatcher guided_matcher;
  HomographyEstimator homography_estimator;
  BackPoseSelector back_pose_selector;
  FeatureSet frame_features;
  std::vector<Eigen::Vector2d> frame_px;  // undistorted, one for each feature
  std::vector<Match> matches;
  std::vector<PointPair> pairs;  // one for each match, undistorted
  std::vector<std::uint8_t> inlier_mask;
  RobustHomography homography;
  std::vector<PredictedView> predicted;  // one for each template feature
  std::vector<PointPair> inliers;
  std::vector<Eigen::Vector2d> inliers_ref;  // normalised
  std::vector<double> disagreement;          // of the inliers' scales
  StageTimes* times = nullptr;
};

PoseEstimator::Impl::Impl(const ShirtTemplate& shirt, const CameraModel& current_camera,
                          const VisionConfig& given)
    : camera(current_camera),
      config(given),
      reference(shirt, given),
      K_cur(camera.K()),
      K_cur_inverse(K_cur.inverse()),
      range(magnification(shirt, camera, config)),
      extractor(camera.width_px, camera.height_px,
                frame_feature_settings(shirt, reference.set, range, config)),
      matcher(static_cast<int>(reference.px.size()), config.max_features,
              MatchSettings{static_cast<float>(config.match_ratio), true}),
      guided_matcher(config.max_features, GuidedMatchSettings{}),
      homography_estimator(static_cast<int>(reference.px.size()), ransac_settings(config)),
      back_pose_selector(reference, K_cur, config) {
  const std::size_t count = reference.px.size();
  shape_limits.scale_min = range.min * kTiltShrink;
  shape_limits.scale_max = range.max * kScaleMargin;

  anywhere.sigma_min_px = extractor.settings().sigma_min_px;
  anywhere.sigma_max_px = extractor.settings().sigma_max_px;

  extractor.reserve(frame_features);
  frame_px.reserve(static_cast<std::size_t>(config.max_features));
  matches.reserve(count);
  pairs.reserve(count);
  inlier_mask.reserve(count);
  predicted.resize(count);
  inliers.reserve(count);
  inliers_ref.reserve(count);
  disagreement.reserve(count);
}

/// The outline's bounding box and the features' scales under H, with room for what may have changed in
/// `dt_s`.
ExpectedView PoseEstimator::Impl::expected_view(const Eigen::Matrix3d& H_cur_from_ref, double dt_s) const {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : reference.outline_px)
    box.extend(camera.distort_px((H_cur_from_ref * corner.homogeneous()).hnormalized()));
  const double moved_px = config.tracking_rate_rad_s * dt_s * std::max(camera.fx, camera.fy);
  const Eigen::Vector2d margin_px = kViewMargin * box.sizes() + Eigen::Vector2d::Constant(moved_px);

  ExpectedView view;
  const Eigen::Vector2d first = (box.min() - margin_px).array().floor();
  const Eigen::Vector2d size = (box.sizes() + 2.0 * margin_px).array().ceil();
  view.region = {static_cast<int>(first.x()), static_cast<int>(first.y()), static_cast<int>(size.x()),
                 static_cast<int>(size.y())};

  double smallest = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (std::size_t i = 0; i < reference.px.size(); ++i) {
    const double sigma = reference.set.features[i].sigma_px * local_scale(H_cur_from_ref, reference.px[i]);
    smallest = std::min(smallest, sigma);
    largest = std::max(largest, sigma);
  }
  const double scale_margin = kViewScaleMargin * (1.0 + kApproach_1_s * dt_s);
  view.sigma_min_px = std::max(anywhere.sigma_min_px, smallest / scale_margin);
  view.sigma_max_px = std::min(anywhere.sigma_max_px, largest * scale_margin);
  view.upsample = is_small(H_cur_from_ref);
  return view;
}

bool PoseEstimator::Impl::is_small(const Eigen::Matrix3d& H_cur_from_ref) const {
  return local_scale(H_cur_from_ref, reference.centre_px) < kSmall;
}

bool PoseEstimator::Impl::needs_upsampled_pass(const PoseEstimate& pose) const {
  if (pose.inliers < kMinPairsForUpsampling) return false;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> H(pose.H_cur_from_ref.data());
  return plausible_shape(H, reference.outline_px, shape_limits) && is_small(H);
}

/// Steps 1–4: features of the frame, their nearest neighbours in the template, lens distortion removed.
PoseReason PoseEstimator::Impl::find_pairs(const FrameView& frame, const ExpectedView& search,
                                           PoseEstimate& pose) {
  FeatureSettings settings = extractor.settings();
  settings.sigma_min_px = static_cast<float>(search.sigma_min_px);
  settings.sigma_max_px = static_cast<float>(search.sigma_max_px);
  settings.upsample = search.upsample;
  extractor.set_settings(settings);
  extractor.extract(frame, search.region, frame_features);
  frame_px.clear();
  pose.frame_features = static_cast<std::uint32_t>(frame_features.features.size());
  if (frame_features.features.size() < 4) return PoseReason::TooFewFeatures;

  matcher.match(reference.set, frame_features, matches);
  mark(times, VisionStage::Matching);
  pose.matches = static_cast<std::uint32_t>(matches.size());
  if (matches.size() < 4) return PoseReason::TooFewMatches;

  for (const Feature& feature : frame_features.features) frame_px.push_back(undistorted(camera, feature));
  make_pairs(matches);
  mark(times, VisionStage::Undistortion);
  return PoseReason::Found;
}

void PoseEstimator::Impl::make_pairs(const std::vector<Match>& from) {
  pairs.clear();
  for (const Match& match : from)
    pairs.push_back(
        {reference.px[static_cast<std::size_t>(match.ref)], frame_px[static_cast<std::size_t>(match.cur)]});
}

/// Steps 5 and 6: the homography most pairs agree on, and the certainty.
PoseReason PoseEstimator::Impl::find_homography(PoseEstimate& pose) {
  homography = homography_estimator.estimate(pairs, inlier_mask);
  mark(times, VisionStage::Homography);
  if (homography.status != HomographyStatus::Ok) return PoseReason::NoHomography;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.H_cur_from_ref.data()) =
      homography.H_cur_from_ref;
  pose.inliers = static_cast<std::uint32_t>(homography.inliers);
  pose.certainty = static_cast<double>(homography.inliers) / static_cast<double>(reference.px.size());
  return homography.inliers < config.min_inliers ? PoseReason::TooFewInliers : PoseReason::Found;
}

PoseReason PoseEstimator::Impl::check_shape() {
  if (!plausible_shape(homography.H_cur_from_ref, reference.outline_px, shape_limits) ||
      !feature_scales_agree())
    return PoseReason::ImplausibleShape;
  return PoseReason::Found;
}

/// The inliers' features have grown or shrunk, by the median, as the homography says.
bool PoseEstimator::Impl::feature_scales_agree() {
  disagreement.clear();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    if (inlier_mask[i] == 0) continue;
    const Feature& ref = reference.set.features[static_cast<std::size_t>(matches[i].ref)];
    const Feature& cur = frame_features.features[static_cast<std::size_t>(matches[i].cur)];
    const double expected = local_scale(homography.H_cur_from_ref, pairs[i].ref_px);
    disagreement.push_back(std::abs(std::log(static_cast<double>(cur.sigma_px) / ref.sigma_px / expected)));
  }
  const auto middle = disagreement.begin() + static_cast<std::ptrdiff_t>(disagreement.size() / 2);
  std::nth_element(disagreement.begin(), middle, disagreement.end());
  return *middle <= std::log(kMaxScaleDisagreement);
}

/// How far the homography puts the outline's corners from where `guide` did, at most.
double PoseEstimator::Impl::moved_px(const Eigen::Matrix3d& guide) const {
  double most_px = 0.0;
  for (const Eigen::Vector2d& corner : reference.outline_px)
    most_px = std::max(most_px, ((homography.H_cur_from_ref * corner.homogeneous()).hnormalized() -
                                 (guide * corner.homogeneous()).hnormalized())
                                    .norm());
  return most_px;
}

void PoseEstimator::Impl::predict_from_homography() {
  const Eigen::Matrix3d& H = homography.H_cur_from_ref;
  for (std::size_t i = 0; i < predicted.size(); ++i)
    predicted[i] = {(H * reference.px[i].homogeneous()).hnormalized(), local_scale(H, reference.px[i])};
}

/// Steps 3–6 once more, guided by a homography that has passed every check: more pairs, above all towards the
/// edges, so a steadier fit. The first round's error at the edges may be larger than the guide's radius; then
/// a second starts from a better one. Only now, when the pairs there are have been found, is the certainty
/// held to its floor.
PoseReason PoseEstimator::Impl::match_again(PoseEstimate& pose) {
  guided_matcher.look_at(frame_features, frame_px);
  for (int round = 0; round < kGuidedRounds; ++round) {
    predict_from_homography();
    guided_matcher.match(predicted, reference.set, matches);
    make_pairs(matches);
    mark(times, VisionStage::GuidedMatching);
    const Eigen::Matrix3d guide = homography.H_cur_from_ref;
    const PoseReason reason = find_homography(pose);
    if (reason != PoseReason::Found) return reason;
    if (moved_px(guide) < kSettled_px) break;
  }
  return pose.certainty < config.min_certainty ? PoseReason::TooFewInliers : PoseReason::Found;
}

/// Steps 7 and 8: decomposition, choice, and the pose with its precision.
PoseReason PoseEstimator::Impl::find_motion(PoseEstimate& pose) {
  inliers.clear();
  inliers_ref.clear();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (inlier_mask[i] == 0) continue;
    inliers.push_back(pairs[i]);
    inliers_ref.push_back((reference.K_inverse * pairs[i].ref_px.homogeneous()).hnormalized());
  }
  const PlaneMotions motions =
      decompose_plane_motion(K_cur_inverse * homography.H_cur_from_ref * reference.K);
  const MotionChoice choice = choose_motion(motions, inliers_ref);
  if (choice.best < 0) return PoseReason::NoValidMotion;

  const PlaneMotion& start = motions.motions[static_cast<std::size_t>(choice.best)];
  const FrontalPose result =
      back_pose_selector.estimate({inliers, homography.H_cur_from_ref, start}, guided_matcher, frame_px);
  const Eigen::Matrix3d& R = result.motion.R_cur_from_ref;
  const Eigen::Vector3d& t = result.motion.t_over_d;
  const Eigen::Vector3d centre_over_d = R * (reference.K_inverse * reference.centre_px.homogeneous()) + t;
  // In front of the camera, its outside towards it.
  if (!(centre_over_d.z() > 0.0) || !(R.col(2).dot(centre_over_d) > 0.0)) return PoseReason::NoValidMotion;

  pose.yaw_rad = result.yaw_rad;
  pose.yaw_sigma_rad = result.yaw_sigma_rad;
  Eigen::Map<Eigen::Vector3d>(pose.t_over_d.data()) = t;
  Eigen::Map<Eigen::Vector3d>(pose.t_over_d_sigma.data()) = result.t_over_d_sigma;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.R_cur_from_ref.data()) = R;
  pose.has_distance = reference.distance_m > 0.0;
  if (pose.has_distance)
    Eigen::Map<Eigen::Vector3d>(pose.position_m.data()) = reference.distance_m * centre_over_d;
  return PoseReason::Found;
}

PoseEstimator::PoseEstimator(const ShirtTemplate& shirt, const CameraModel& camera,
                             const VisionConfig& config)
    : impl_(std::make_unique<Impl>(shirt, camera, config)) {}
PoseEstimator::~PoseEstimator() = default;
PoseEstimator::PoseEstimator(PoseEstimator&&) noexcept = default;
PoseEstimator& PoseEstimator::operator=(PoseEstimator&&) noexcept = default;

PoseEstimate PoseEstimator::estimate(const FrameView& frame) {
  return impl_->estimate(frame, impl_->anywhere);
}

PoseEstimate PoseEstimator::estimate(const FrameView& frame, const ExpectedView& expected) {
  return impl_->estimate(frame, expected);
}

ExpectedView PoseEstimator::expected_view(const PoseEstimate& last, TimeNs t_ns) const {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> H_cur_from_ref(
      last.H_cur_from_ref.data());
  return impl_->expected_view(H_cur_from_ref, seconds_from_ns(t_ns - last.t_capture_ns));
}

bool PoseEstimator::needs_upsampled_pass(const PoseEstimate& pose) const {
  return impl_->needs_upsampled_pass(pose);
}

void PoseEstimator::measure(StageTimes* times) {
  impl_->times = times;
  impl_->extractor.measure(times);
}

/// The paper's steps, in its order.
PoseEstimate PoseEstimator::Impl::estimate(const FrameView& frame, const ExpectedView& search) {
  PoseEstimate pose;
  pose.frame_sequence = frame.header.sequence;
  pose.t_capture_ns = frame.header.t_capture_ns;
  pose.template_features = static_cast<std::uint32_t>(reference.px.size());

  if (frame.header.width_px != static_cast<std::uint32_t>(camera.width_px) ||
      frame.header.height_px != static_cast<std::uint32_t>(camera.height_px)) {
    pose.reason = PoseReason::WrongFrameSize;
    return pose;
  }
  pose.reason = find_pairs(frame, search, pose);
  if (pose.found()) pose.reason = find_homography(pose);
  if (pose.found()) pose.reason = check_shape();
  if (pose.found()) pose.reason = match_again(pose);
  if (pose.found()) pose.reason = check_shape();
  if (pose.found()) pose.reason = find_motion(pose);
  mark(times, VisionStage::Motion);
  return pose;
}

}  // namespace heel
