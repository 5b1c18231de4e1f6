// The rotation of a square fiducial marker in a picture, by libraries of others.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "heel/camera_model.h"

namespace heel::test {

inline constexpr double kMarkerSide_m = 0.2;

class MarkerDetector {
 public:
  virtual ~MarkerDetector() = default;
  /// R_cam_from_marker; nothing when the marker is not found.
  virtual std::optional<Eigen::Matrix3d> rotation(const cv::Mat& grey) = 0;
};

/// AprilTag 36h11 by libapriltag; null when it was not there at build time.
std::unique_ptr<MarkerDetector> make_apriltag_detector(const CameraModel& camera, int id);
/// ArUco DICT_4X4_50 by OpenCV; null when it was not there at build time.
std::unique_ptr<MarkerDetector> make_aruco_detector(const CameraModel& camera, int id);

}  // namespace heel::test
