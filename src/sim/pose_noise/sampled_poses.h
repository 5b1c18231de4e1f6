// Random poses by the pose-noise model, frame after frame, in place of rendered pictures and vision.
#pragma once

#include <cstdint>

#include "core/random.h"
#include "heel/flow.h"
#include "sim/pose_noise/error_model.h"
#include "sim/scene/world.h"

namespace heel::sim {

class SampledPoses {
 public:
  /// `distance_m` is that of the template. The same seed and truths give the same poses.
  SampledPoses(const ErrorModel& model, const Scenario& scenario, double distance_m, std::uint64_t seed);

  /// The pose for the frame whose exposure is centred on `header.t_capture_ns`; `truth` and `robot` are of
  /// that time.
  PoseEstimate estimate(const FrameHeader& header, const RobotMotion& robot, const Truth& truth);
  /// Time of the last estimate relative to that for a person straight ahead at 2 m, tracked.
  double time_share() const { return time_share_; }

 private:
  /// Standard normal noise: the sum of a part that is constant during the run and a part that is correlated
  /// over time.
  struct CorrelatedNoise {
    double constant_share = 0.0, memory_s = 0.0;
    double constant = 0.0, varying = 0.0;
  };

  double next(CorrelatedNoise& noise, double dt_s);
  double sample(const SpreadModel& model, const ViewConditions& conditions, CorrelatedNoise& noise,
                double dt_s);
  ViewConditions conditions_of_frame(const RobotMotion& robot, const Truth& truth) const;
  void set_pose(const Truth& truth, double yaw_rad, double bearing_rad, double range_m,
                PoseEstimate& pose) const;

  ErrorModel model_;
  CameraModel camera_;
  double exposure_s_;
  double light_;
  bool other_print_;
  double distance_m_;
  double mount_z_m_;
  Random random_;
  CorrelatedNoise found_, aspect_, range_, bearing_;
  bool started_ = false;
  bool ever_found_ = false;
  TimeNs t_last_ns_ = 0, t_last_found_ns_ = 0;
  double time_share_ = 1.0;
  double back_z_m_ = 0.0;  ///< height of the middle of the back in the first frame
};

}  // namespace heel::sim
