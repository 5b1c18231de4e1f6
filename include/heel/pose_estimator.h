// The vision stage: one frame in, one PoseEstimate out; the paper's steps in the paper's order.
#pragma once

#include <memory>

#include "heel/camera_model.h"
#include "heel/config.h"
#include "heel/flow.h"
#include "heel/shirt_template.h"

namespace heel {

/// Pure but for its preallocated memory: the same frame gives the same estimate.
/// `t_done_ns` is left 0 for the caller, who owns the clock.
class PoseEstimator {
 public:
  /// Throws heel::Error when the template cannot be followed or the camera's size is not the frames'.
  PoseEstimator(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config);
  ~PoseEstimator();
  PoseEstimator(PoseEstimator&&) noexcept;
  PoseEstimator& operator=(PoseEstimator&&) noexcept;

  PoseEstimate estimate(const FrameView& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
