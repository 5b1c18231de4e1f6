// A printed shirt on a wall, and its true picture after a known motion.
#pragma once

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "heel/camera_model.h"

namespace heel::test {

inline constexpr int kWidth_px = 640;
inline constexpr int kHeight_px = 480;
inline constexpr const char* kRoi = "240,140,160,200";

inline CameraModel shirt_camera() {
  CameraModel camera;
  camera.width_px = kWidth_px;
  camera.height_px = kHeight_px;
  camera.fx = 610.0;
  camera.fy = 605.0;
  camera.cx = 322.0;
  camera.cy = 238.0;
  return camera;
}

/// A plane covered by prints of many sizes: the reference view.
inline cv::Mat printed_plane() {
  cv::Mat image(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(120));
  cv::RNG random(17);
  for (int i = 0; i < 1600; ++i) {
    const cv::Point at(random.uniform(0, kWidth_px), random.uniform(0, kHeight_px));
    const int size = 2 + static_cast<int>(16 * std::pow(random.uniform(0.0, 1.0), 2));
    const cv::Scalar grey(random.uniform(20, 240));
    if (i % 2 == 0) {
      cv::circle(image, at, size, grey, cv::FILLED, cv::LINE_AA);
    } else {
      cv::rectangle(image, at, at + cv::Point(size, 2 + size / 2), grey, cv::FILLED);
    }
  }
  cv::GaussianBlur(image, image, {}, 0.8);
  return image;
}

/// The plane z = d turned by `yaw_rad` about the camera's y axis through its point on the optical axis, then
/// moved by `move_over_d`: R = R_y(yaw), t/d = (I − R) n + move, H = K (R + (t/d) nᵀ) K⁻¹.
struct TrueMotion {
  double yaw_rad = 0.0;
  cv::Vec3d move_over_d;

  cv::Matx33d R() const {
    const double c = std::cos(yaw_rad);
    const double s = std::sin(yaw_rad);
    return {c, 0, s, 0, 1, 0, -s, 0, c};
  }
  cv::Vec3d t_over_d() const { return cv::Vec3d(0, 0, 1) - R() * cv::Vec3d(0, 0, 1) + move_over_d; }
  cv::Matx33d H() const {
    const CameraModel camera = shirt_camera();
    const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
    const cv::Vec3d t = t_over_d();
    const cv::Matx33d plane = R() + cv::Matx33d(0, 0, t[0], 0, 0, t[1], 0, 0, t[2]);
    const cv::Matx33d H = K * plane * K.inv();
    return H * (1.0 / H(2, 2));
  }
  cv::Mat picture(const cv::Mat& reference) const {
    cv::Mat image;
    cv::warpPerspective(reference, image, H(), reference.size(), cv::INTER_AREA, cv::BORDER_CONSTANT,
                        cv::Scalar(120));
    return image;
  }
};

}  // namespace heel::test
