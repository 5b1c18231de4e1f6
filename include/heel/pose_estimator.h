/// \file
/// The vision stage: one frame in, one PoseEstimate out. Features, matching, homography by RANSAC, motion of
/// the plane, pose of the curved back, in this order.
///
/// - Convention: that of heel::PoseEstimate; positive `yaw_rad` turns the walking direction to the image's
///   right.
/// - Units: pixels, radians; metres where the template's distance is known.
/// - Errors: the constructor throws heel::Error; a frame without a pose carries a heel::PoseReason.
/// - Source: M. Burke, W. Brink, "Estimating Target Orientation with a Single Camera for Use in a
///   Human-Following Robot", PRASA 2010.
#pragma once

#include <array>
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
  bool tracking = false;  ///< expected from an earlier frame; one from the same frame is a second look
  bool unsure = false;    ///< which way it was turned in that earlier frame: read it as in a search
  // The motion of that earlier frame, as in PoseEstimate; the start of the pose while tracking.
  std::array<double, 9> R_cur_from_ref{};
  std::array<double, 3> t_over_d{};
};

/// The same frame (and expectation) gives the same estimate; only memory is kept between frames. `t_done_ns`
/// is left 0 for the caller, who reads the clock.
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

  /// Searches one of the overlapping parts of the frame, upsampled, with views of the template: for what is
  /// small or pale and is not found in the whole frame. `part`: 0…parts() − 1, the middle first.
  PoseEstimate estimate_part(const FrameView& frame, int part);
  static int parts();

  /// Whether the frame of the last estimate, `found` in it, shows the shirt at a second place as well, which
  /// could be followed as well: a whole frame is searched once more, without what was found.
  bool shows_second_place(const FrameView& frame, const PoseEstimate& found);

  /// Where the shirt can be at `t_ns` if it crosses the view no faster than
  /// VisionConfig::tracking_rate_rad_s. `last`: found, by the same camera, not later than `t_ns`.
  ExpectedView expected_view(const PoseEstimate& last, TimeNs t_ns) const;

  /// Whether `pose` of a whole frame, found or not, is based on so few and so small features that a second
  /// search, of the enlarged region where they are, may find the shirt, or find it more precisely.
  bool needs_upsampled_pass(const PoseEstimate& pose) const;

  /// Of the last estimate: the pairs that support its homography; none where it is not found, or a view of
  /// the template found it. Without frame and region, which the caller knows.
  const PoseMarks& marks() const;

  /// From now on the end of each step is reported to `times`, which must outlive this; null: no reports.
  void report_stage_times(StageTimes* times);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
