#include "heel/pose_tracker.h"

namespace heel {
namespace {

// After this long without a sighting the target may be anywhere, nearer or farther.
constexpr TimeNs kForgotten_ns = kNsPerS / 2;

}  // namespace

PoseTracker::PoseTracker(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config)
    : estimator_(shirt, camera, config), config_(config) {}

/// A frame that is older than the last one found comes from a source that has begun again.
bool PoseTracker::expects_it_in(const FrameView& frame) const {
  const TimeNs age_ns = frame.header.t_capture_ns - last_.t_capture_ns;
  return config_.tracking && last_.found() && age_ns >= 0 && age_ns <= kForgotten_ns;
}

PoseEstimate PoseTracker::search(const FrameView& frame) {
  const PoseEstimate pose = estimator_.estimate(frame);
  if (!estimator_.needs_upsampled_pass(pose)) return pose;
  const PoseEstimate closer =
      estimator_.estimate(frame, estimator_.expected_view(pose, frame.header.t_capture_ns));
  return closer.found() ? closer : pose;
}

PoseEstimate PoseTracker::estimate(const FrameView& frame) {
  PoseEstimate pose;
  if (expects_it_in(frame)) {
    pose = estimator_.estimate(frame, estimator_.expected_view(last_, frame.header.t_capture_ns));
    pose.tracked = pose.found();
  }
  if (!pose.found()) pose = search(frame);
  if (pose.found()) last_ = pose;
  return pose;
}

}  // namespace heel
