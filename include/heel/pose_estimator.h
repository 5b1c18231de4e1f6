// The vision stage: one frame in, one PoseEstimate out; the paper's steps in the paper's order.
#pragma once

#include <memory>

#include "heel/camera_model.h"
#include "heel/features.h"
#include "heel/flow.h"
#include "heel/shirt_template.h"
#include "heel/vision_config.h"

namespace heel {

/// Where and at which sizes the shirt is expected in a frame.
struct ExpectedView {
  Region region;  ///< pixels of the frame; may reach beyond it
  double sigma_min_px = 0.0, sigma_max_px = 0.0;
  bool upsample = false;  ///< it is small there: FeatureSettings::upsample
};

/// Pure but for its preallocated memory: the same frame (and expectation) gives the same estimate.
/// `t_done_ns` is left 0 for the caller, who owns the clock.
class PoseEstimator {
 public:
  /// Throws heel::Error when the template cannot be followed or the camera's size is not the frames'.
  PoseEstimator(const ShirtTemplate& shirt, const CameraModel& camera, const VisionConfig& config);
  ~PoseEstimator();
  PoseEstimator(PoseEstimator&&) noexcept;
  PoseEstimator& operator=(PoseEstimator&&) noexcept;

  /// Searches the whole frame, at every size at which the robot may follow.
  PoseEstimate estimate(const FrameView& frame);
  /// Searches only where the shirt is expected.
  PoseEstimate estimate(const FrameView& frame, const ExpectedView& expected);

  /// Where the shirt can be at `t_ns`, when it was found as in `last` (found, same camera, not later than
  /// `t_ns`) and moves no faster than `vision.tracking_rate_rad_s` through the view.
  ExpectedView expected_view(const PoseEstimate& last, TimeNs t_ns) const;

  /// True: `pose` of a whole frame, found or not, rests on pairs so few and so small that looking once more,
  /// where they say the shirt is, may find it, or find it better.
  bool needs_upsampled_pass(const PoseEstimate& pose) const;

  /// From now on `times`, which must outlive this, hears of the steps; null: nobody does.
  void measure(StageTimes* times);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
