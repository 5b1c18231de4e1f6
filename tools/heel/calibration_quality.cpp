#include "calibration_quality.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace heel::cli {
namespace {

constexpr double kPersonAhead_cm = 300.0;
constexpr double kMaxGapShare = 0.1;
// Columns of cv::projectPoints' derivatives: pose of the board, fx fy cx cy, k1 k2 p1 p2 k3.
constexpr int kPoseColumn = 0, kIntrinsicColumn = 6;
constexpr int kIntrinsics = 8;  // with k3: 9

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Eigen::MatrixXd derivatives(const CameraModel& camera, const std::vector<cv::Point3f>& points,
                            const cv::Mat& rotation, const cv::Mat& translation) {
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const cv::Vec<double, 5> D(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
  std::vector<cv::Point2f> ignored;
  cv::Mat J;
  cv::projectPoints(points, rotation, translation, K, D, ignored, J);
  return Eigen::Map<const RowMajor>(J.ptr<double>(), J.rows, J.cols);
}

/// The inverse of the intrinsics' covariance for σ = 1 px: the normal equations without the boards' poses
/// (Schur complement).
Eigen::MatrixXd information(const CameraModel& camera, int intrinsics,
                            const std::vector<std::vector<cv::Point3f>>& points_m,
                            const std::vector<cv::Mat>& rotations, const std::vector<cv::Mat>& translations) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(intrinsics, intrinsics);
  for (std::size_t view = 0; view < rotations.size(); ++view) {
    const Eigen::MatrixXd J = derivatives(camera, points_m[view], rotations[view], translations[view]);
    const Eigen::MatrixXd pose = J.middleCols(kPoseColumn, 6),
                          own = J.middleCols(kIntrinsicColumn, intrinsics);
    const Eigen::MatrixXd mixed = own.transpose() * pose;
    sum += own.transpose() * own - mixed * (pose.transpose() * pose).ldlt().solve(mixed.transpose());
  }
  return sum;
}

CameraModel changed(CameraModel camera, const Eigen::VectorXd& change) {
  double* const parameters[] = {&camera.fx, &camera.fy, &camera.cx, &camera.cy, &camera.k1,
                                &camera.k2, &camera.p1, &camera.p2, &camera.k3};
  for (Eigen::Index i = 0; i < change.size(); ++i) *parameters[i] += change(i);
  return camera;
}

Eigen::Vector2d direction_at(const CameraModel& camera, const Eigen::Vector2d& px) {
  const Eigen::Vector2d undistorted = camera.undistort_px(px);
  return {(undistorted.x() - camera.cx) / camera.fx, (undistorted.y() - camera.cy) / camera.fy};
}

}  // namespace

// The intrinsics are moved by two standard deviations along each axis of their covariance, both ways, and the
// direction is computed again: the derivative at the solution alone would be too good where a coefficient is
// hardly determined.
std::vector<CameraModel> cameras_within_95(const CameraModel& camera, bool with_k3, double sigma_px,
                                           const std::vector<std::vector<cv::Point3f>>& points_m,
                                           const std::vector<cv::Mat>& rotations,
                                           const std::vector<cv::Mat>& translations) {
  const Eigen::MatrixXd inverse =
      information(camera, kIntrinsics + (with_k3 ? 1 : 0), points_m, rotations, translations);
  // Scaled to 1 on its diagonal, because focal lengths and coefficients differ by orders of magnitude.
  const Eigen::VectorXd scale = inverse.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(scale.asDiagonal() * inverse *
                                                            scale.asDiagonal());
  std::vector<CameraModel> cameras;
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    const double information_of_axis = std::max(axes.eigenvalues()(i), 1e-12);
    const Eigen::VectorXd step =
        2.0 * sigma_px / std::sqrt(information_of_axis) * scale.cwiseProduct(axes.eigenvectors().col(i));
    cameras.push_back(changed(camera, step));
    cameras.push_back(changed(camera, -step));
  }
  return cameras;
}

EdgeErrors edge_errors(const CameraModel& camera, const std::vector<CameraModel>& within_95,
                       const std::vector<CameraModel>& without_a_part,
                       const std::optional<CameraModel>& simpler) {
  const auto error_cm = [&](const Eigen::Vector2d& px) {
    const Eigen::Vector2d direction = direction_at(camera, px);
    const auto moved = [&](const CameraModel& other) {
      return (direction_at(other, px) - direction).squaredNorm();
    };
    double by_covariance = 0.0, by_parts = 0.0;
    for (std::size_t i = 0; i + 1 < within_95.size(); i += 2)
      by_covariance += std::max(moved(within_95[i]), moved(within_95[i + 1]));
    for (const CameraModel& other : without_a_part) by_parts += moved(other);
    const auto parts = static_cast<double>(std::max<std::size_t>(without_a_part.size(), 1));
    by_parts *= 4.0 * (parts - 1.0) / parts;  // twice the standard deviation
    const double by_simpler = simpler ? moved(*simpler) : 0.0;
    return kPersonAhead_cm * std::sqrt(std::max({by_covariance, by_parts, by_simpler}));
  };
  const double right = camera.width_px - 1, bottom = camera.height_px - 1;
  const auto largest = [&](std::initializer_list<Eigen::Vector2d> places_px) {
    double most_cm = 0.0;
    for (const Eigen::Vector2d& px : places_px) {
      const double cm = error_cm(px);
      most_cm = std::isfinite(cm) ? std::max(most_cm, cm) : std::numeric_limits<double>::infinity();
    }
    return most_cm;
  };
  return {largest({{0.5 * right, 0.5 * bottom}}), largest({{0, 0.5 * bottom}, {right, 0.5 * bottom}}),
          largest({{0, 0}, {right, 0}, {0, bottom}, {right, bottom}})};
}

std::string parts_not_shown(cv::Size image_size, const std::vector<std::vector<cv::Point2f>>& corners_px) {
  float left = 1.f, upper = 1.f, right = 0.f, lower = 0.f;  // of the picture's width and height
  for (const std::vector<cv::Point2f>& view : corners_px) {
    for (const cv::Point2f& corner : view) {
      left = std::min(left, corner.x / static_cast<float>(image_size.width));
      right = std::max(right, corner.x / static_cast<float>(image_size.width));
      upper = std::min(upper, corner.y / static_cast<float>(image_size.height));
      lower = std::max(lower, corner.y / static_cast<float>(image_size.height));
    }
  }
  std::string parts;
  for (const auto& [name, gap] : {std::pair{"left", left}, std::pair{"right", 1.f - right},
                                  std::pair{"upper", upper}, std::pair{"lower", 1.f - lower}}) {
    if (gap > static_cast<float>(kMaxGapShare))
      parts += fmt::format("{}the {} {:.0f} %", parts.empty() ? "" : ", ", name, 100.f * gap);
  }
  return parts;
}

}  // namespace heel::cli
