// What a calibration was not shown: how far directions at the edge of the picture may be wrong.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "heel/camera_model.h"

namespace heel::cli {

/// How far a person 3 m ahead of the camera may be from where they are seen, centimetres, at twice the
/// standard deviation (95 %).
struct EdgeErrors {
  double centre_cm = 0.0;
  double side_cm = 0.0;    ///< the middle of the left and of the right edge
  double corner_cm = 0.0;  ///< the largest of the four corners
};

/// The camera moved by two standard deviations along each axis of the intrinsics' covariance, both ways.
/// `points_m`: of the board, those of each view; `rotations` and `translations`: its pose in each view.
/// `sigma_px`: of one coordinate of a corner.
std::vector<CameraModel> cameras_within_95(const CameraModel& camera, bool with_k3, double sigma_px,
                                           const std::vector<std::vector<cv::Point3f>>& points_m,
                                           const std::vector<cv::Mat>& rotations,
                                           const std::vector<cv::Mat>& translations);

/// By the largest of three estimates: the covariance of the intrinsics (cameras_within_95), for which the
/// corners' errors are independent; and the jackknife, calibrations each without a part of the views (B.
/// Efron, "The Jackknife, the Bootstrap and Other Resampling Plans", 1982), for which those of one view need
/// not be; and `simpler`, a camera with a coefficient less that explains the views as well, where there is
/// one.
EdgeErrors edge_errors(const CameraModel& camera, const std::vector<CameraModel>& within_95,
                       const std::vector<CameraModel>& without_a_part,
                       const std::optional<CameraModel>& simpler);

/// The parts of the picture in which no view has a corner, "the left 24 %, the upper 30 %"; empty when
/// corners come within 10 % of each edge.
std::string parts_not_shown(cv::Size image_size, const std::vector<std::vector<cv::Point2f>>& corners_px);

}  // namespace heel::cli
