// Frame after frame: the shirt is looked for first where the last frame says it must be, then everywhere.
#pragma once

#include "heel/pose_estimator.h"

namespace heel {

/// Depends on the frames before only through the last estimate that was found; the same frames in the same
/// order give the same estimates. A frame in which the shirt is not where it was expected is searched whole,
/// so that tracking costs time at most, never a detection. Allocates nothing.
class PoseTracker {
 public:
  /// As PoseEstimator. Without `config.tracking` every frame is searched whole.
  PoseTracker(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config);

  PoseEstimate estimate(const FrameView& frame);

  /// As PoseEstimator.
  void measure(StageTimes* times) { estimator_.measure(times); }

 private:
  PoseEstimate search(const FrameView& frame);
  bool expects_it_in(const FrameView& frame) const;

  PoseEstimator estimator_;
  VisionConfig config_;
  PoseEstimate last_;  ///< the last one found
};

}  // namespace heel
