// What a method says about every picture of a foreign set: heel's own vision stage, or planar matching by
// OpenCV beside it.
#pragma once

#include <functional>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "evaluation/experiments/foreign_set.h"
#include "heel/flow.h"
#include "heel/vision_config.h"

namespace heel::evaluation {

struct ForeignAnswer {
  bool found = false;
  std::string reason;
  double certainty = 0.0;
  std::uint32_t inliers = 0;
  double yaw_rad = 0.0;
  double yaw_sigma_rad = std::numeric_limits<double>::quiet_NaN();  ///< NaN: the method states none
  Eigen::Vector3d position_m{0, 0, 0};
};

ForeignAnswer answer_of(const PoseEstimate& pose);

/// Estimates one picture after the other; `t_s` is its time in a walk.
using PoseFunction = std::function<ForeignAnswer(const cv::Mat& grey, double t_s)>;

struct ForeignMethod {
  std::string name;
  /// `in_sequence`: the pictures that follow are the frames of one walk; otherwise they have nothing to do
  /// with each other.
  std::function<PoseFunction(const ShirtTemplate& shirt, const CameraModel& camera, bool in_sequence)> begin;
};

/// heel as the daemon runs it.
ForeignMethod heel_method(const VisionConfig& vision);

struct ForeignRow {
  std::string method;
  ForeignPicture picture;
  ForeignAnswer answer;
};

/// All stills in the order of the set, each by itself, then all walks, each as a sequence. A picture without
/// a usable template is not found. `on_progress` may be empty.
std::vector<ForeignRow> answer_foreign_set(const ForeignSet& set, const ForeignTemplates& templates,
                                           const ForeignMethod& method,
                                           const std::function<void(std::size_t done)>& on_progress);

/// One row a picture and method, with the truth and the errors.
void write_foreign_rows(const std::vector<ForeignRow>& rows, const std::string& path);

}  // namespace heel::evaluation
