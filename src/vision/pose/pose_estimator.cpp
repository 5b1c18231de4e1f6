// One frame's way through vision, in the order of M. Burke and W. Brink, "Estimating Target Orientation with
// a Single Camera for Use in a Human-Following Robot" (PRASA 2010): see PoseEstimator::Impl::estimate.
#include "heel/pose_estimator.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <optional>
#include <span>

#include "heel/motion.h"
#include "vision/homography/homography_4pt.h"
#include "vision/matching/template_matcher.h"
#include "vision/pose/back_pose_selector.h"
#include "vision/pose/frame_features.h"
#include "vision/pose/plane_fitter.h"
#include "vision/pose/pose_workspace.h"
#include "vision/pose/second_place_search.h"
#include "vision/pose/view_predictor.h"
#include "vision/pose/view_search.h"
#include "vision/template/reference_view.h"

namespace heel {
namespace {

// So few supporting pairs are no detection, but enough of a hint to search their place again, upsampled.
constexpr std::uint32_t kMinInliersForUpsampling = 5;

constexpr int kSearchPatchRounds = 3;  // patches are aligned and the pose is solved so often

using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Eigen::Matrix3d homography_of(const PoseEstimate& pose) {
  return Eigen::Map<const RowMajor3d>(pose.H_cur_from_ref.data());
}

VisionConfig with_feature_budget(const CameraModel& camera, VisionConfig config) {
  config.max_features = frame_feature_budget(camera, config);
  return config;
}

FrontalMotion last_motion(const ExpectedView& expected) {
  FrontalMotion motion;
  motion.R_cur_from_ref = Eigen::Map<const RowMajor3d>(expected.R_cur_from_ref.data());
  motion.t_over_d = Eigen::Map<const Eigen::Vector3d>(expected.t_over_d.data());
  return motion;
}

PoseEstimate with_reason(PoseEstimate pose, PoseReason reason) {
  pose.reason = reason;
  return pose;
}

/// Every n-th of the pairs, so that they fit.
void mark_inliers(std::span<const PointPair> inliers, PoseMarks& marks) {
  const std::size_t step = (inliers.size() + PoseMarks::kMostInliers - 1) / PoseMarks::kMostInliers;
  marks.inliers = 0;
  for (std::size_t i = 0; i < inliers.size(); i += step) {
    const Eigen::Vector2f px = inliers[i].cur_px.cast<float>();
    marks.inlier_px[marks.inliers++] = {px.x(), px.y()};
  }
}

PoseEstimate with_homography(PoseEstimate pose, const PlaneFit& fit) {
  pose.reason = fit.reason;
  if (fit.inliers.empty()) return pose;
  Eigen::Map<RowMajor3d>(pose.H_cur_from_ref.data()) = fit.H_cur_from_ref;
  pose.inliers = static_cast<std::uint32_t>(fit.inliers.size());
  pose.certainty = fit.certainty;
  return pose;
}

/// The inliers of the homography lie on one facet of a turned back; those of its surface count, too.
PoseEstimate with_inliers_of_back(PoseEstimate pose, std::size_t pairs) {
  pose.inliers = std::max(pose.inliers, static_cast<std::uint32_t>(pairs));
  pose.certainty = static_cast<double>(pose.inliers) / pose.template_features;
  return pose;
}

/// Not found where the back would be behind the camera, or would show it its inside.
PoseEstimate with_back_pose(PoseEstimate pose, const FrontalPose& back, const ReferenceView& reference) {
  const Eigen::Matrix3d& R = back.motion.R_cur_from_ref;
  const Eigen::Vector3d& t_over_d = back.motion.t_over_d;
  const Eigen::Vector3d centre_over_d =
      R * (reference.K_inverse * reference.centre_px.homogeneous()) + t_over_d;
  if (!(centre_over_d.z() > 0.0) || !(R.col(2).dot(centre_over_d) > 0.0))
    return with_reason(pose, PoseReason::NoValidMotion);

  pose.reason = PoseReason::Found;
  pose.yaw_rad = pose.frame_yaw_rad = back.yaw_rad;
  pose.yaw_sigma_rad = pose.frame_yaw_sigma_rad = back.yaw_sigma_rad;
  Eigen::Map<Eigen::Vector3d>(pose.t_over_d.data()) = t_over_d;
  Eigen::Map<Eigen::Vector3d>(pose.t_over_d_sigma.data()) = back.t_over_d_sigma;
  Eigen::Map<RowMajor3d>(pose.R_cur_from_ref.data()) = R;
  pose.has_distance = reference.distance_m > 0.0;
  if (pose.has_distance)
    Eigen::Map<Eigen::Vector3d>(pose.position_m.data()) = reference.distance_m * centre_over_d;
  return pose;
}

/// Unchanged where no view has shown the back, but for the reason of a candidate that only patches refused.
PoseEstimate with_view(PoseEstimate pose, const ViewDetection& seen, const ReferenceView& reference) {
  if (seen.reason == PoseReason::PatchesDisagree) pose.reason = seen.reason;
  if (!seen.found()) return pose;
  PoseEstimate with_back = with_back_pose(pose, seen.pose, reference);
  if (!with_back.found()) return pose;
  Eigen::Map<RowMajor3d>(with_back.H_cur_from_ref.data()) = seen.H_cur_from_ref;
  with_back.template_features = seen.view_features;
  with_back.inliers = seen.inliers;
  with_back.certainty = seen.certainty;
  return with_back;
}

}  // namespace

struct PoseEstimator::Impl {
  /// `config` with the budget of the whole frame.
  Impl(const ShirtTemplate& shirt, const CameraModel& current_camera, const VisionConfig& config,
       int closer_look_features);

  PoseEstimate estimate(const FrameView& frame, const ExpectedView& search, FrameFeatures::Search kind);
  PoseEstimate estimate_part(const FrameView& frame, int part);
  PoseEstimate not_found_yet(const FrameView& frame) const;
  bool shows_second_place(const FrameView& frame, const PoseEstimate& found);
  PoseEstimate steps(PoseEstimate pose, const FrameView& frame, const FeatureGrid& frame_grid,
                     const ExpectedView& search, PoseWorkspace& work);

  bool fits_camera(const FrameView& frame) const;
  PlaneMotions decompose(const PlaneFit& fit) const;
  std::optional<PlaneMotion> choose(const PlaneMotions& motions, const PlaneFit& fit,
                                    PoseWorkspace& work) const;

  CameraModel camera;
  ReferenceView reference;
  Eigen::Matrix3d K_cur, K_cur_inverse;
  MagnificationRange range;
  FrameFeatures frame_features;
  ViewPredictor view_predictor;
  TemplateMatcher matcher;
  PlaneFitter plane_fitter;
  SurfacePoseRefiner patch_refiner;
  BackPoseSelector back_pose_selector;
  ViewSearch view_search;
  SecondPlaceSearch second_place_search;
  PoseWorkspace workspace;
  PoseMarks marks;
  bool whole_frame_is_searched = false;  // the features of the last frame, not those of an earlier one
};

PoseEstimator::Impl::Impl(const ShirtTemplate& shirt, const CameraModel& current_camera,
                          const VisionConfig& config, int closer_look_features)
    : camera(current_camera),
      reference(shirt, config),
      K_cur(camera.K()),
      K_cur_inverse(K_cur.inverse()),
      range(magnification_range(shirt, camera, config)),
      frame_features(camera, frame_feature_settings(shirt, reference.set, range, config),
                     closer_look_features),
      view_predictor(reference, camera, config, frame_features.settings()),
      matcher(reference.set, config.max_features, static_cast<float>(config.match_ratio)),
      plane_fitter(reference, frame_shape_limits(range), config),
      patch_refiner(shirt, camera),
      back_pose_selector(reference, K_cur, config, patch_refiner),
      view_search(shirt, reference, camera, config, back_pose_selector.curved_surface(),
                  frame_shape_limits(range), view_predictor, frame_features, patch_refiner),
      second_place_search(reference, matcher, plane_fitter, view_search, config.max_features),
      workspace(reference.px.size()) {}

PoseEstimate PoseEstimator::Impl::not_found_yet(const FrameView& frame) const {
  PoseEstimate pose;
  pose.frame_sequence = frame.header.sequence;
  pose.t_capture_ns = frame.header.t_capture_ns;
  pose.template_features = static_cast<std::uint32_t>(reference.px.size());
  return pose;
}

PoseEstimate PoseEstimator::Impl::estimate_part(const FrameView& frame, int part) {
  PoseEstimate pose = not_found_yet(frame);
  marks.inliers = 0;
  if (!fits_camera(frame)) return with_reason(pose, PoseReason::WrongFrameSize);
  const ExpectedView expected = view_predictor.upsampled_part(part);
  const FeatureGrid& features = frame_features.find(frame, expected, FrameFeatures::Search::ExpectedView);
  pose.frame_features = static_cast<std::uint32_t>(features.features().features.size());
  if (pose.frame_features < kHomographyPairs) return with_reason(pose, PoseReason::TooFewFeatures);
  pose = with_view(with_reason(pose, PoseReason::NoHomography),
                   view_search.search(frame, magnified(features, expected)), reference);
  mark(workspace.times, VisionStage::Motion);
  return pose;
}

/// The paper's steps, in its order; where they fail, views of the template.
PoseEstimate PoseEstimator::Impl::estimate(const FrameView& frame, const ExpectedView& search,
                                           FrameFeatures::Search kind) {
  PoseEstimate pose = not_found_yet(frame);
  marks.inliers = 0;
  if (!fits_camera(frame)) return with_reason(pose, PoseReason::WrongFrameSize);
  const FeatureGrid& features = frame_features.find(frame, search, kind);
  pose.frame_features = static_cast<std::uint32_t>(features.features().features.size());
  if (pose.frame_features < kHomographyPairs) return with_reason(pose, PoseReason::TooFewFeatures);

  pose = steps(pose, frame, features, search, workspace);
  if (!pose.found()) {
    marks.inliers = 0;
    pose = with_view(pose, view_search.search(frame, magnified(features, search)), reference);
  }
  mark(workspace.times, VisionStage::Motion);
  return pose;
}

bool PoseEstimator::Impl::shows_second_place(const FrameView& frame, const PoseEstimate& found) {
  constexpr auto kWholeFrame = FrameFeatures::Search::WholeFrame;
  const FeatureGrid& features = whole_frame_is_searched
                                    ? frame_features.last(kWholeFrame)
                                    : frame_features.find(frame, view_predictor.whole_frame(), kWholeFrame);
  const bool shown = second_place_search.shows_second_place(frame, features, found, workspace);
  mark(workspace.times, VisionStage::Motion);
  return shown;
}

PoseEstimate PoseEstimator::Impl::steps(PoseEstimate pose, const FrameView& frame,
                                        const FeatureGrid& frame_grid, const ExpectedView& search,
                                        PoseWorkspace& work) {
  const std::span<const Match> matches = matcher.match_everywhere(frame_grid.features());
  mark(work.times, VisionStage::Matching);
  pose.matches = static_cast<std::uint32_t>(matches.size());
  if (matches.size() < kHomographyPairs) return with_reason(pose, PoseReason::TooFewMatches);

  PlaneFit fit = plane_fitter.fit(matches, frame_grid, work);
  if (fit.found()) fit = plane_fitter.fit_guided(fit, matcher, frame_grid, work);
  pose = with_homography(pose, fit);  // and the certainty
  if (!fit.found()) return pose;
  mark_inliers(fit.inliers, marks);

  const PlaneMotions motions = decompose(fit);
  const std::optional<PlaneMotion> motion = choose(motions, fit, work);
  if (!motion) return with_reason(pose, PoseReason::NoValidMotion);
  const PlaneSolution plane{fit.inliers, fit.H_cur_from_ref, *motion};
  const FrameContent content{frame, frame_grid};
  const BackPose back = search.tracking && !search.unsure
                            ? back_pose_selector.estimate_next(last_motion(search), plane, matcher, content)
                            : back_pose_selector.estimate(plane, matcher, content, kSearchPatchRounds);
  return with_back_pose(with_inliers_of_back(pose, back.pairs), back.pose, reference);
}

bool PoseEstimator::Impl::fits_camera(const FrameView& frame) const {
  return frame.header.width_px == static_cast<std::uint32_t>(camera.width_px) &&
         frame.header.height_px == static_cast<std::uint32_t>(camera.height_px);
}

PlaneMotions PoseEstimator::Impl::decompose(const PlaneFit& fit) const {
  return decompose_plane_motion(K_cur_inverse * fit.H_cur_from_ref * reference.K);
}

std::optional<PlaneMotion> PoseEstimator::Impl::choose(const PlaneMotions& motions, const PlaneFit& fit,
                                                       PoseWorkspace& work) const {
  work.inliers_ref_normalised.clear();
  for (const PointPair& pair : fit.inliers)
    work.inliers_ref_normalised.push_back((reference.K_inverse * pair.ref_px.homogeneous()).hnormalized());
  const MotionChoice choice = choose_motion(motions, work.inliers_ref_normalised);
  if (choice.best < 0) return std::nullopt;
  return motions.motions[static_cast<std::size_t>(choice.best)];
}

PoseEstimator::PoseEstimator(const ShirtTemplate& shirt, const CameraModel& camera,
                             const VisionConfig& config)
    : impl_(std::make_unique<Impl>(shirt, camera, with_feature_budget(camera, config), config.max_features)) {
}
PoseEstimator::~PoseEstimator() = default;
PoseEstimator::PoseEstimator(PoseEstimator&&) noexcept = default;
PoseEstimator& PoseEstimator::operator=(PoseEstimator&&) noexcept = default;

PoseEstimate PoseEstimator::estimate(const FrameView& frame) {
  impl_->whole_frame_is_searched = true;
  return impl_->estimate(frame, impl_->view_predictor.whole_frame(), FrameFeatures::Search::WholeFrame);
}

PoseEstimate PoseEstimator::estimate(const FrameView& frame, const ExpectedView& expected) {
  if (expected.tracking) impl_->whole_frame_is_searched = false;
  return impl_->estimate(frame, expected, FrameFeatures::Search::ExpectedView);
}

bool PoseEstimator::shows_second_place(const FrameView& frame, const PoseEstimate& found) {
  return impl_->shows_second_place(frame, found);
}

PoseEstimate PoseEstimator::estimate_part(const FrameView& frame, int part) {
  impl_->whole_frame_is_searched = false;
  return impl_->estimate_part(frame, part);
}

const PoseMarks& PoseEstimator::marks() const {
  return impl_->marks;
}

int PoseEstimator::parts() {
  return ViewPredictor::kParts;
}

ExpectedView PoseEstimator::expected_view(const PoseEstimate& last, TimeNs t_ns) const {
  ExpectedView expected =
      impl_->view_predictor.near(homography_of(last), seconds_from_ns(t_ns - last.t_capture_ns));
  expected.R_cur_from_ref = last.R_cur_from_ref;
  expected.t_over_d = last.t_over_d;
  return expected;
}

bool PoseEstimator::needs_upsampled_pass(const PoseEstimate& pose) const {
  if (pose.inliers < kMinInliersForUpsampling) return false;
  const Eigen::Matrix3d H_cur_from_ref = homography_of(pose);
  return impl_->plane_fitter.plausible(H_cur_from_ref) && impl_->view_predictor.is_small(H_cur_from_ref);
}

void PoseEstimator::report_stage_times(StageTimes* times) {
  impl_->workspace.times = times;
  impl_->frame_features.report_stage_times(times);
}

}  // namespace heel
