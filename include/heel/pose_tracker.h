/// \file
/// Poses of a sequence of frames: each frame is searched where the last pose predicts the shirt, then as a
/// whole.
///
/// - Convention, units, errors and source: those of heel/pose_estimator.h.
#pragma once

#include "heel/pose_estimator.h"

namespace heel {

/// Keeps the last estimate that was found, nothing else of earlier frames; the same frames in the same order
/// give the same estimates. A frame in which the shirt is not where it was expected is searched as a whole:
/// tracking may cost time but never a detection. Allocates nothing after construction.
class PoseTracker {
 public:
  /// As PoseEstimator. Without VisionConfig::tracking every frame is searched as a whole.
  PoseTracker(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config);

  PoseEstimate estimate(const FrameView& frame);

  /// As PoseEstimator.
  void measure(StageTimes* times) { estimator_.measure(times); }

 private:
  PoseEstimate search_whole_frame(const FrameView& frame);
  bool predicts_view_in(const FrameView& frame) const;

  PoseEstimator estimator_;
  VisionConfig config_;
  PoseEstimate last_found_;
};

}  // namespace heel
