// Where in a frame, and at which feature sizes, the template can be: anywhere from which it can be followed,
// or near the place where an earlier frame showed it.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "heel/camera_model.h"
#include "heel/features.h"
#include "heel/pose_estimator.h"
#include "heel/shirt_template.h"
#include "heel/vision_config.h"
#include "vision/homography/shape_plausibility.h"
#include "vision/template/reference_view.h"

namespace heel {

/// Smallest and largest magnification of the template, current to reference image, between the configured
/// distances.
struct MagnificationRange {
  double min = 1.0, max = 1.0;
};

/// Throws heel::Error when the camera has no size or focal length.
MagnificationRange magnification_range(const ShirtTemplate& shirt, const CameraModel& camera,
                                       const VisionConfig& config);

/// VisionConfig::max_features is meant for a picture 640 pixels wide: a wider one of the same scene shows
/// more of its detail, and with as few features a small print would be crowded out.
int frame_feature_budget(const CameraModel& camera, const VisionConfig& config);

/// Settings that find every feature of the template within the range of magnification.
FeatureSettings frame_feature_settings(const ShirtTemplate& shirt, const FeatureSet& reference,
                                       const MagnificationRange& range, const VisionConfig& config);

/// What the outline of the template can look like within the range of magnification.
ShapeLimits frame_shape_limits(const MagnificationRange& range);

class ViewPredictor {
 public:
  /// `reference` must outlive this.
  ViewPredictor(const ReferenceView& reference, const CameraModel& camera, const VisionConfig& config,
                const FeatureSettings& frame_settings);

  /// The whole frame, every size at which the template can be followed.
  const ExpectedView& whole_frame() const { return whole_frame_; }

  /// Overlapping parts of the frame, in the order in which they are searched, the middle first. Upsampled,
  /// each has the size of a frame; so what is small or pale is found, which the whole frame's stronger
  /// features crowd out.
  static constexpr int kParts = 9;
  ExpectedView upsampled_part(int index) const;

  /// The bounding box of the outline and the sizes of the features under H, with a margin for what may have
  /// changed in `dt_s`.
  ExpectedView near(const Eigen::Matrix3d& H_cur_from_ref, double dt_s) const;
  /// The same for a rough pose in this frame, whose error is a share of the back's size.
  ExpectedView near_candidate(const Eigen::Matrix3d& H_cur_from_ref) const;

  /// True: the template is so small that few of its features are as large as the smallest filter.
  bool is_small(const Eigen::Matrix3d& H_cur_from_ref) const;

 private:
  Eigen::AlignedBox2d outline_box(const Eigen::Matrix3d& H_cur_from_ref) const;
  ExpectedView around(const Eigen::Matrix3d& H_cur_from_ref, const Eigen::AlignedBox2d& box,
                      const Eigen::Vector2d& margin_px, double scale_margin) const;

  const ReferenceView& reference_;
  CameraModel camera_;
  double tracking_rate_rad_s_;
  ExpectedView whole_frame_;
};

}  // namespace heel
