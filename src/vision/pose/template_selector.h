// Several templates of one person (from the side, from the front, of another distance, in other light): which
// of them is used changes by evidence. The current one is searched first. Only in a frame in which it is not
// found one other is searched, in turn, and takes over where the person can be: at the place that the last
// second's pose predicts, or else when it is found in two frames in a row.
//
// Convention: poses are in the terms of the back, whatever template has shown it: see in_terms_of_back().
// Units: metres, radians.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "heel/camera_model.h"
#include "heel/flow.h"
#include "heel/pose_tracker.h"
#include "heel/shirt_template.h"
#include "heel/stage_times.h"
#include "heel/vision_config.h"
#include "vision/picture/picture_monitor.h"
#include "vision/pose/pose_of_back.h"

namespace heel {

/// The same frames in the same order give the same estimates. With one template, taught from behind, they are
/// those of PoseTracker, to the bit. At most two templates are searched in a frame. Without
/// VisionConfig::tracking every frame is searched by itself, with all of them in their order. Allocates
/// nothing after construction.
class TemplateSelector {
 public:
  /// The first of `templates` is that of the configuration key target.shirt. Throws heel::Error as
  /// PoseTracker does, and if there are several and one has no distance.
  TemplateSelector(std::span<const ShirtTemplate> templates, const CameraModel& camera,
                   const VisionConfig& config);

  PoseEstimate estimate(const FrameView& frame);

  /// Of the last estimate, by the template that it names.
  PoseMarks marks(std::size_t template_index) const { return trackers_[template_index].marks(); }

  /// As PoseEstimator.
  void report_stage_times(StageTimes* times);

 private:
  PoseEstimate estimate_in_turn(const FrameView& frame);
  PoseEstimate estimate_alone(const FrameView& frame);
  PoseEstimate estimate_with(std::size_t index, const FrameView& frame);
  PoseEstimate try_another(const FrameView& frame, const PoseEstimate& refused);
  bool takes_over(const PoseEstimate& pose) const;

  bool tracking_;
  PictureMonitor picture_monitor_;
  std::vector<PoseTracker> trackers_;     // one for each template
  std::vector<PoseOfBack> pose_of_back_;  // the same
  std::size_t current_ = 0, next_ = 0;
  PoseEstimate last_found_;                // by the current template
  std::optional<PoseEstimate> candidate_;  // by another template, in the last frame
};

}  // namespace heel
