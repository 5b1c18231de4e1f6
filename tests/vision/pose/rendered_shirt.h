// A printed back in front of clutter, as the robot's camera sees it: the template's region as a plane that
// has moved.
#pragma once

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "heel/flow.h"
#include "heel/shirt_template.h"
#include "heel/vision_config.h"
#include "vision/pose/scene.h"

namespace heel::test {

/// A print with detail at every scale.
inline cv::Mat texture(std::uint64_t seed, int width_px, int height_px) {
  cv::theRNG().state = seed;
  cv::Mat sum = cv::Mat::zeros(height_px, width_px, CV_32F);
  for (const int cell_px : {5, 10, 20, 40}) {
    cv::Mat coarse(height_px / cell_px + 2, width_px / cell_px + 2, CV_32F), fine;
    cv::randn(coarse, 0.0, 1.0);
    cv::resize(coarse, fine, sum.size(), 0, 0, cv::INTER_CUBIC);
    sum += fine;
  }
  cv::Mat grey;
  sum.convertTo(grey, CV_8U, 28.0, 128.0);
  return grey;
}

inline heel::CameraModel template_camera() {
  heel::CameraModel camera = plain_camera();
  camera.k1 = -0.12;
  camera.k2 = 0.03;
  camera.p1 = 0.001;
  return camera;
}

inline heel::CameraModel robot_camera() {
  heel::CameraModel camera = plain_camera();
  camera.fx = 520.0;
  camera.fy = 523.0;
  camera.cx = 310.0;
  camera.cy = 251.0;
  camera.k1 = -0.25;
  camera.k2 = 0.07;
  camera.p2 = -0.0015;
  return camera;
}

inline heel::ShirtTemplate shirt() {
  heel::ShirtTemplate shirt;
  shirt.camera = template_camera();
  const cv::Mat image = texture(11, 640, 480);
  shirt.grey.assign(image.data, image.data + image.total());
  shirt.roi = {220, 100, 200, 280};
  shirt.distance_m = 2.0;
  return shirt;
}

/// The frame of the robot's camera: the template's region as a plane moved by (R, t), with clutter round it.
inline cv::Mat render(const heel::ShirtTemplate& shirt, const Eigen::Matrix3d& H_cur_from_ref,
                      std::uint64_t clutter_seed) {
  const heel::CameraModel camera = robot_camera();
  const Eigen::Matrix3d H_ref_from_cur = H_cur_from_ref.inverse();
  const cv::Mat reference(shirt.camera.height_px, shirt.camera.width_px, CV_8U,
                          const_cast<std::uint8_t*>(shirt.grey.data()));
  cv::Mat map(camera.height_px, camera.width_px, CV_32FC2);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Eigen::Vector3d p =
          H_ref_from_cur *
          camera.undistort_px({static_cast<double>(x), static_cast<double>(y)}).homogeneous();
      const Eigen::Vector2d ref_px = shirt.camera.distort_px(p.hnormalized());
      map.at<cv::Vec2f>(y, x) = {static_cast<float>(ref_px.x()), static_cast<float>(ref_px.y())};
    }
  }
  cv::Mat plane, frame = texture(clutter_seed, camera.width_px, camera.height_px);
  cv::Mat smooth;
  cv::GaussianBlur(reference, smooth, {}, 0.7);
  cv::remap(smooth, plane, map, cv::noArray(), cv::INTER_LINEAR);
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const cv::Vec2f at = map.at<cv::Vec2f>(y, x);
      if (at[0] >= static_cast<float>(shirt.roi.x_px) && at[1] >= static_cast<float>(shirt.roi.y_px) &&
          at[0] < static_cast<float>(shirt.roi.x_px + shirt.roi.width_px) &&
          at[1] < static_cast<float>(shirt.roi.y_px + shirt.roi.height_px))
        frame.at<std::uint8_t>(y, x) = plane.at<std::uint8_t>(y, x);
    }
  }
  cv::Mat noise(frame.size(), CV_16S), noisy;
  cv::randn(noise, 0.0, 2.0);
  cv::add(frame, noise, noisy, cv::noArray(), CV_8U);
  return noisy;
}

inline heel::FrameView view_of(const cv::Mat& image) {
  heel::FrameView view;
  view.header.sequence = 42;
  view.header.t_capture_ns = 123456789;
  view.header.width_px = static_cast<std::uint32_t>(image.cols);
  view.header.height_px = static_cast<std::uint32_t>(image.rows);
  view.grey = image.data;
  view.stride_bytes = static_cast<std::uint32_t>(image.step);
  return view;
}

/// The default configuration for a shirt that is exactly a plane, as the rendered one is.
inline heel::VisionConfig flat_shirt_config() {
  heel::VisionConfig config;
  config.back_curvature_1_m = 0.0;
  config.back_curvature_sigma_1_m = 0.0;
  config.back_shape_sigma_m = 0.0;
  return config;
}

inline Eigen::Matrix3d homography(const Eigen::Matrix3d& R, const Eigen::Vector3d& t_over_d) {
  return homography_of(template_camera().K(), robot_camera().K(), R, t_over_d);
}

/// The plane's centre at `depth` times the template's distance, almost straight ahead.
inline Eigen::Vector3d t_over_d_for(const Eigen::Matrix3d& R, double x, double depth) {
  return Eigen::Vector3d(x * depth, 0.02 * depth, depth) - R * Eigen::Vector3d::UnitZ();
}

}  // namespace heel::test
