// Poses drawn from the error model, frame after frame, in place of pictures and vision.
#pragma once

#include <cstdint>

#include "core/random.h"
#include "heel/flow.h"
#include "sim/pose_noise/error_model.h"
#include "sim/scene/world.h"

namespace heel::sim {

class SampledPoses {
 public:
  /// `distance_m` is the template's. The same seed and the same truths give the same poses.
  SampledPoses(const ErrorModel& model, const Scenario& scenario, double distance_m, std::uint64_t seed);

  /// What vision makes of the frame whose exposure is centred on `header.t_capture_ns`. `truth` and `robot`
  /// are of that moment.
  PoseEstimate estimate(const FrameHeader& header, const RobotMotion& robot, const Truth& truth);
  /// Time the last estimate took over that for a person straight ahead at 2 m, tracked.
  double time_share() const { return time_share_; }

 private:
  /// A standard normal value that remembers: a part for good, the rest fading.
  struct Memory {
    double share_for_good = 0.0, memory_s = 0.0;
    double for_good = 0.0, fading = 0.0;
  };

  double next(Memory& memory, double dt_s);
  double drawn(const SpreadModel& model, const ViewConditions& conditions, Memory& memory, double dt_s);
  ViewConditions conditions_now(const RobotMotion& robot, const Truth& truth) const;
  void fill(const Truth& truth, double yaw_rad, double bearing_rad, double range_m, PoseEstimate& pose) const;

  ErrorModel model_;
  CameraModel camera_;
  double exposure_s_;
  double light_;
  bool other_print_;
  double distance_m_;
  double mount_z_m_;
  Random random_;
  Memory found_, aspect_, range_, bearing_;
  bool started_ = false;
  bool ever_found_ = false;
  TimeNs t_last_ns_ = 0, t_last_found_ns_ = 0;
  double time_share_ = 1.0;
  double back_z_m_ = 0.0;  ///< height of the middle of the back when first seen
};

}  // namespace heel::sim
