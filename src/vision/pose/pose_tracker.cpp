#include "heel/pose_tracker.h"

#include <cmath>

#include "core/angles.h"
#include "vision/pose/yaw_filter.h"

namespace heel {
namespace {

// A detection older than this does not limit the search: the target may be anywhere by now.
constexpr TimeNs kMaxPredictionAge_ns = kNsPerS / 2;
// The same person moves less between two frames, as a share of the shirt's width.
constexpr double kContinuedShare = 0.5;
// A single frame's yaw has a deviation of 2 to 6 degrees, or it may be that of the other minimum.
constexpr double kUnsure_rad = 8.0 * kRadPerDeg;
// After as many frames a track is no mistake.
constexpr int kFramesOfTrack = 3;

struct Centre {
  double x_px, y_px;
};

Centre centre_of(const Region& region) {
  return {region.x_px + 0.5 * region.width_px, region.y_px + 0.5 * region.height_px};
}

}  // namespace

PoseTracker::PoseTracker(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config)
    : estimator_(shirt, camera, config), yaw_filter_(std::make_unique<YawFilter>()), config_(config) {}
PoseTracker::~PoseTracker() = default;
PoseTracker::PoseTracker(PoseTracker&&) noexcept = default;
PoseTracker& PoseTracker::operator=(PoseTracker&&) noexcept = default;

/// A frame older than the last detection comes from a source that has started again.
bool PoseTracker::predicts_view_in(const FrameView& frame) const {
  const TimeNs age_ns = frame.header.t_capture_ns - last_found_.t_capture_ns;
  return config_.tracking && last_found_.found() && age_ns >= 0 && age_ns <= kMaxPredictionAge_ns;
}

PoseEstimate PoseTracker::search_whole_frame(const FrameView& frame) {
  const PoseEstimate pose = estimator_.estimate(frame);
  if (!estimator_.needs_upsampled_pass(pose)) return pose;
  const PoseEstimate upsampled =
      estimator_.estimate(frame, estimator_.expected_view(pose, frame.header.t_capture_ns));
  return upsampled.found() ? upsampled : pose;
}

PoseEstimate PoseTracker::search_all_parts(const FrameView& frame, PoseEstimate pose) {
  for (int part = 0; part < PoseEstimator::parts() && !pose.found(); ++part) {
    const PoseEstimate of_part = estimator_.estimate_part(frame, part);
    if (of_part.found()) pose = of_part;
  }
  return pose;
}

PoseEstimate PoseTracker::search(const FrameView& frame) {
  if (!config_.tracking) return search_all_parts(frame, search_whole_frame(frame));
  const bool whole = !part_is_next_;
  part_is_next_ = whole;
  if (whole) return search_whole_frame(frame);
  const int part = next_part_;
  next_part_ = (next_part_ + 1) % PoseEstimator::parts();
  return estimator_.estimate_part(frame, part);
}

/// Nearly where the last pose was.
bool PoseTracker::continues_last(const PoseEstimate& pose) const {
  const Region last = estimator_.expected_view(last_found_, last_found_.t_capture_ns).region;
  const Centre before = centre_of(last),
               now = centre_of(estimator_.expected_view(pose, pose.t_capture_ns).region);
  return std::hypot(now.x_px - before.x_px, now.y_px - before.y_px) < kContinuedShare * last.width_px;
}

/// In the region in which the last pose predicts the shirt.
bool PoseTracker::within_reach(const PoseEstimate& pose) const {
  const Region region = estimator_.expected_view(last_found_, pose.t_capture_ns).region;
  const Centre now = centre_of(estimator_.expected_view(pose, pose.t_capture_ns).region);
  return now.x_px >= region.x_px && now.x_px < region.x_px + region.width_px && now.y_px >= region.y_px &&
         now.y_px < region.y_px + region.height_px;
}

/// On a pose that was found: Found, or why it is not to be followed.
PoseReason PoseTracker::verdict_on(const PoseEstimate& pose, const FrameView& frame) {
  const bool has_prediction = predicts_view_in(frame);
  if (has_prediction && continues_last(pose)) {
    ++frames_continued_;
    return PoseReason::Found;
  }
  if (has_prediction && frames_continued_ >= kFramesOfTrack && !within_reach(pose))
    return PoseReason::OutOfReach;
  if (estimator_.shows_second_place(frame, pose)) return PoseReason::Ambiguous;
  frames_continued_ = 0;
  return PoseReason::Found;
}

PoseEstimate PoseTracker::estimate(const FrameView& frame) {
  PoseEstimate pose = estimate_frame(frame);
  if (!config_.tracking || !pose.found()) return pose;
  const FilteredYaw yaw =
      yaw_filter_->update(pose.t_capture_ns, pose.frame_yaw_rad, pose.frame_yaw_sigma_rad);
  pose.yaw_rad = yaw.yaw_rad;
  pose.yaw_sigma_rad = yaw.sigma_rad;
  return pose;
}

PoseMarks PoseTracker::marks() const {
  PoseMarks marks = estimator_.marks();
  marks.frame_sequence = expected_.frame_sequence;
  marks.has_region = expected_.has_region;
  marks.region_px = expected_.region_px;
  return marks;
}

PoseEstimate PoseTracker::estimate_frame(const FrameView& frame) {
  PoseEstimate pose;
  expected_.frame_sequence = frame.header.sequence;
  expected_.has_region = predicts_view_in(frame);
  if (expected_.has_region) {
    ExpectedView expected = estimator_.expected_view(last_found_, frame.header.t_capture_ns);
    expected.tracking = true;
    expected.unsure = last_found_.frame_yaw_sigma_rad > kUnsure_rad;
    const Region& region = expected.region;
    expected_.region_px = {region.x_px, region.y_px, region.x_px + region.width_px,
                           region.y_px + region.height_px};
    pose = estimator_.estimate(frame, expected);
    pose.tracked = pose.found();
  }
  if (!pose.found()) pose = search(frame);
  if (!pose.found()) return pose;
  pose.reason = verdict_on(pose, frame);
  if (!pose.found()) {
    pose.tracked = false;
    return pose;
  }
  last_found_ = pose;
  part_is_next_ = false;
  next_part_ = 0;
  return pose;
}

}  // namespace heel
