// A printed curved back in front of clutter, rendered forwards: every small piece of the template's region is
// projected, and a pixel is the mean of the pieces that fall on it.
#pragma once

#include <cmath>
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

/// Where the frame shows the corners of the region's pixels; none where the cloth is turned away.
class CornersInFrame {
 public:
  CornersInFrame(const heel::ShirtTemplate& shirt, const heel::CameraModel& camera,
                 const BackSurface& surface, const Eigen::Matrix3d& R, const Eigen::Vector3d& t_over_d)
      : columns_(shirt.roi.width_px + 1) {
    const Eigen::Matrix3d K_ref_inverse = shirt.camera.K().inverse(), KR = camera.K() * R;
    const Eigen::Vector3d Kt = camera.K() * t_over_d;
    for (int j = 0; j <= shirt.roi.height_px; ++j) {
      for (int i = 0; i <= shirt.roi.width_px; ++i) {
        const Eigen::Vector2d ref_px(shirt.roi.x_px + i - 0.5, shirt.roi.y_px + j - 0.5);
        const Eigen::Vector3d ray = K_ref_inverse * shirt.camera.undistort_px(ref_px).homogeneous();
        const bool visible = image_derivative(surface, K_ref_inverse, KR, Kt, ray).determinant() > 0.0;
        px_.push_back(visible ? camera.distort_px((KR * surface.point(ray) + Kt).hnormalized())
                              : Eigen::Vector2d::Constant(std::nan("")));
      }
    }
  }
  const Eigen::Vector2d& at(int i, int j) const {
    return px_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(i)];
  }
  /// Of a place in the pixel (i, j), with parts `a` across and `b` down of it.
  Eigen::Vector2d in_pixel(int i, int j, double a, double b) const {
    return (1.0 - b) * ((1.0 - a) * at(i, j) + a * at(i + 1, j)) +
           b * ((1.0 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
  }

 private:
  int columns_;
  std::vector<Eigen::Vector2d> px_;
};

/// The frame of robot_camera(). No part of the surface may cover another.
inline cv::Mat render_back(const heel::ShirtTemplate& shirt, const BackSurface& surface,
                           const Eigen::Matrix3d& R, const Eigen::Vector3d& t_over_d,
                           std::uint64_t clutter_seed) {
  constexpr int kPiecesPerPixel = 5;
  const heel::CameraModel camera = robot_camera();
  const CornersInFrame corners(shirt, camera, surface, R, t_over_d);
  const cv::Mat reference(shirt.camera.height_px, shirt.camera.width_px, CV_8U,
                          const_cast<std::uint8_t*>(shirt.grey.data()));
  cv::Mat frame = texture(clutter_seed, camera.width_px, camera.height_px);
  cv::Mat sum = cv::Mat::zeros(frame.size(), CV_32F), count = sum.clone();
  for (int j = 0; j < kPiecesPerPixel * shirt.roi.height_px; ++j) {
    for (int i = 0; i < kPiecesPerPixel * shirt.roi.width_px; ++i) {
      const double a = (i % kPiecesPerPixel + 0.5) / kPiecesPerPixel,
                   b = (j % kPiecesPerPixel + 0.5) / kPiecesPerPixel;
      const Eigen::Vector2d px = corners.in_pixel(i / kPiecesPerPixel, j / kPiecesPerPixel, a, b);
      if (!px.allFinite()) continue;
      const int x = static_cast<int>(std::lround(px.x())), y = static_cast<int>(std::lround(px.y()));
      if (x < 0 || y < 0 || x >= frame.cols || y >= frame.rows) continue;
      sum.at<float>(y, x) += bilinear(reference, {shirt.roi.x_px + i / kPiecesPerPixel + a - 0.5,
                                                  shirt.roi.y_px + j / kPiecesPerPixel + b - 0.5});
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
