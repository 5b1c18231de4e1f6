/// \file
/// Poses of a sequence of frames: each frame is searched where the last pose predicts the shirt, then as a
/// whole.
///
/// - Convention, units, errors and source: those of heel/pose_estimator.h.
#pragma once

#include <memory>

#include "heel/pose_estimator.h"

namespace heel {

class YawFilter;

/// Keeps the last estimate that was found, and the yaw over the frames; the same frames in the same order
/// give the same estimates. With VisionConfig::tracking, `yaw_rad` is filtered over the frames: of a person
/// who walks, cloth moves a single frame's yaw by several degrees. A frame in which the shirt is not where it
/// was expected is searched as a whole: tracking may cost time but never a detection. While nothing is found
/// in whole frames, every second frame is searched in one of its parts instead
/// (PoseEstimator::estimate_part), in turn, which bounds the time of every frame: a shirt that only its part
/// shows is found within 2 · parts() frames. A search must find the shirt at one place only: a frame that
/// shows it at two is refused as PoseReason::Ambiguous, and a pose that has moved far since the last frame is
/// held to the same. Beside a person who was tracked until half a second ago, nobody is found where that
/// person cannot have come to: PoseReason::OutOfReach. Allocates nothing after construction.
class PoseTracker {
 public:
  /// As PoseEstimator. Without VisionConfig::tracking every frame is searched by itself: as a whole, then in
  /// all of its parts.
  PoseTracker(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config);
  ~PoseTracker();
  PoseTracker(PoseTracker&&) noexcept;
  PoseTracker& operator=(PoseTracker&&) noexcept;

  PoseEstimate estimate(const FrameView& frame);

  /// Of the last estimate.
  PoseMarks marks() const;

  /// As PoseEstimator.
  void report_stage_times(StageTimes* times) { estimator_.report_stage_times(times); }

 private:
  PoseEstimate search(const FrameView& frame);
  PoseEstimate estimate_frame(const FrameView& frame);
  PoseEstimate search_whole_frame(const FrameView& frame);
  PoseEstimate search_all_parts(const FrameView& frame, PoseEstimate pose);
  bool predicts_view_in(const FrameView& frame) const;
  PoseReason verdict_on(const PoseEstimate& pose, const FrameView& frame);
  bool continues_last(const PoseEstimate& pose) const;
  bool within_reach(const PoseEstimate& pose) const;

  PoseEstimator estimator_;
  std::unique_ptr<YawFilter> yaw_filter_;
  VisionConfig config_;
  PoseEstimate last_found_;
  PoseMarks expected_;  // of the last frame: without inliers
  bool part_is_next_ = false;
  int next_part_ = 0;
  int frames_continued_ = 0;  // in a row, up to last_found_
};

}  // namespace heel
