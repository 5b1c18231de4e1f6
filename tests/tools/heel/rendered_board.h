// Views of a chessboard, rendered through a known camera with distortion.
#pragma once

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <vector>

namespace heel::test {

inline constexpr int kWidth_px = 640;
inline constexpr int kHeight_px = 480;
inline constexpr double kSquare_m = 0.03;
inline const cv::Size kInnerCorners(9, 6);
inline const cv::Matx33d kTrueK(610.0, 0, 325.0, 0, 605.0, 236.0, 0, 0, 1);
inline const std::vector<double> kTrueDistortion = {-0.22, 0.08, 0.0008, -0.0011};

struct BoardPose {
  double pitch_deg, yaw_deg, roll_deg;
  double x_m, y_m, z_m;  ///< centre of the board in the camera frame
};

inline const std::vector<BoardPose> kGoodPoses = {
    {30, 0, 3, -0.05, 0.02, 0.45},  {-30, 5, -4, 0.05, -0.02, 0.45},  {0, 35, 8, -0.08, 0.0, 0.50},
    {5, -35, -8, 0.08, 0.03, 0.50}, {25, 25, 15, 0.0, 0.05, 0.55},    {-25, 20, -15, -0.04, -0.05, 0.40},
    {0, 0, 0, 0.07, 0.05, 0.42},    {20, -28, 20, 0.02, -0.04, 0.48},
};

/// Brightness of the board at a point of its plane, metres from its first inner corner: squares, a white
/// margin of one square, grey beyond.
inline double board_brightness(double x_m, double y_m) {
  const double column = x_m / kSquare_m + 1.0;
  const double row = y_m / kSquare_m + 1.0;
  if (column < -1 || row < -1 || column > kInnerCorners.width + 2 || row > kInnerCorners.height + 2)
    return 90.0;
  if (column < 0 || row < 0 || column > kInnerCorners.width + 1 || row > kInnerCorners.height + 1)
    return 235.0;
  const bool dark = (static_cast<int>(column) + static_cast<int>(row)) % 2 == 0;
  return dark ? 25.0 : 235.0;
}

/// Every pixel is the mean of 3 × 3 rays.
inline cv::Mat render_board(const BoardPose& pose) {
  const double rad = CV_PI / 180.0;
  cv::Matx33d Rx, Ry, Rz;
  cv::Rodrigues(cv::Vec3d(pose.pitch_deg * rad, 0, 0), Rx);
  cv::Rodrigues(cv::Vec3d(0, pose.yaw_deg * rad, 0), Ry);
  cv::Rodrigues(cv::Vec3d(0, 0, pose.roll_deg * rad), Rz);
  const cv::Matx33d R = Rz * Ry * Rx;  // camera from board
  const cv::Vec3d centre_on_board_m((kInnerCorners.width - 1) * kSquare_m / 2,
                                    (kInnerCorners.height - 1) * kSquare_m / 2, 0);
  const cv::Vec3d t = cv::Vec3d(pose.x_m, pose.y_m, pose.z_m) - R * centre_on_board_m;
  const cv::Vec3d normal = R * cv::Vec3d(0, 0, 1);

  constexpr int kRays = 3;
  cv::Mat image(kHeight_px, kWidth_px, CV_8UC1);
  for (int v = 0; v < kHeight_px; ++v) {
    std::vector<cv::Point2d> rays_px;
    for (int u = 0; u < kWidth_px; ++u) {
      for (int i = 0; i < kRays * kRays; ++i) {
        rays_px.emplace_back(u + (i % kRays + 0.5) / kRays - 0.5, v + (i / kRays + 0.5) / kRays - 0.5);
      }
    }
    std::vector<cv::Point2d> rays;
    cv::undistortPoints(rays_px, rays, kTrueK, kTrueDistortion);
    for (int u = 0; u < kWidth_px; ++u) {
      double sum = 0.0;
      for (int i = 0; i < kRays * kRays; ++i) {
        const cv::Point2d& p = rays[static_cast<std::size_t>(u * kRays * kRays + i)];
        const cv::Vec3d ray(p.x, p.y, 1.0);
        const cv::Vec3d on_board = R.t() * (ray * (normal.dot(t) / normal.dot(ray)) - t);
        sum += board_brightness(on_board[0], on_board[1]);
      }
      image.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(sum / (kRays * kRays));
    }
  }
  return image;
}

}  // namespace heel::test
