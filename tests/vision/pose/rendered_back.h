// A printed curved back in front of clutter, rendered forwards: every small piece of the template's region is
// projected, and a pixel is the mean of the pieces that fall on it.
#pragma once

#include <vector>

#include "vision/pose/back_surface.h"
#include "vision/pose/rendered_shirt.h"
#include "vision/template/reference_view.h"

namespace heel::test {

/// `px` must lie inside of the picture.
inline float bilinear(const cv::Mat& grey, const Eigen::Vector2d& px) {
  const int x = static_cast<int>(px.x()), y = static_cast<int>(px.y());
  const float fx = static_cast<float>(px.x() - x), fy = static_cast<float>(px.y() - y);
  const std::uint8_t *upper = grey.ptr(y) + x, *lower = grey.ptr(y + 1) + x;
  return (1.f - fy) * ((1.f - fx) * static_cast<float>(upper[0]) + fx * static_cast<float>(upper[1])) +
         fy * ((1.f - fx) * static_cast<float>(lower[0]) + fx * static_cast<float>(lower[1]));
}

/// The frame of robot_camera(). No part of the surface may cover another.
inline cv::Mat render_back(const heel::ShirtTemplate& shirt, const BackSurface& surface,
                           const Eigen::Matrix3d& R, const Eigen::Vector3d& t_over_d,
                           std::uint64_t clutter_seed) {
  constexpr int kPiecesPerPixel = 5;
  const heel::CameraModel camera = robot_camera();
  const Eigen::Matrix3d K_ref_inverse = shirt.camera.K().inverse(), KR = camera.K() * R;
  const Eigen::Vector3d Kt = camera.K() * t_over_d;
  const cv::Mat reference(shirt.camera.height_px, shirt.camera.width_px, CV_8U,
                          const_cast<std::uint8_t*>(shirt.grey.data()));
  cv::Mat frame = texture(clutter_seed, camera.width_px, camera.height_px);
  cv::Mat sum = cv::Mat::zeros(frame.size(), CV_32F), count = sum.clone();
  for (int j = 0; j < kPiecesPerPixel * shirt.roi.height_px; ++j) {
    for (int i = 0; i < kPiecesPerPixel * shirt.roi.width_px; ++i) {
      const Eigen::Vector2d ref_px(shirt.roi.x_px + (i + 0.5) / kPiecesPerPixel - 0.5,
                                   shirt.roi.y_px + (j + 0.5) / kPiecesPerPixel - 0.5);
      const Eigen::Vector3d ray = K_ref_inverse * shirt.camera.undistort_px(ref_px).homogeneous();
      if (image_derivative(surface, K_ref_inverse, KR, Kt, ray).determinant() <= 0.0) continue;
      const Eigen::Vector2d px = camera.distort_px((KR * surface.point(ray) + Kt).hnormalized());
      const int x = static_cast<int>(std::lround(px.x())), y = static_cast<int>(std::lround(px.y()));
      if (x < 0 || y < 0 || x >= frame.cols || y >= frame.rows) continue;
      sum.at<float>(y, x) += bilinear(reference, ref_px);
      count.at<float>(y, x) += 1.f;
    }
  }
  for (int y = 0; y < frame.rows; ++y)
    for (int x = 0; x < frame.cols; ++x)
      if (count.at<float>(y, x) > 0.f)
        frame.at<std::uint8_t>(y, x) =
            cv::saturate_cast<std::uint8_t>(sum.at<float>(y, x) / count.at<float>(y, x));
  cv::Mat noise(frame.size(), CV_16S), noisy;
  cv::randn(noise, 0.0, 2.0);
  cv::add(frame, noise, noisy, cv::noArray(), CV_8U);
  return noisy;
}

}  // namespace heel::test
