#include "card_distance.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <vector>

#include "board_finder.h"
#include "card_sheet.h"
#include "core/angles.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

// A print that is too high or too wide looks turned: at this angle by 6 %.
constexpr double kMostTilt_deg = 20.0;
// More than this, and than this part of a square: bent, or another camera.
constexpr double kMostRms_px = 0.4;
constexpr double kMostRmsOfSquare = 0.03;
constexpr double kLeastSigma_px = 0.1;   // as exactly as a corner can be found in a sharp picture
constexpr double kScaleSigma = 0.005;    // of the distance: printers, and focal lengths of calibrations
constexpr double kLeastSquare_px = 5.0;  // smaller squares are not found

const cv::Size kCorners(kCardColumns - 1, kCardRows - 1);

std::vector<cv::Point2f> corners_of_card(const cv::Mat& grey) {
  const FoundCorners found = find_corners(grey, {kCorners, kCardSquare_m, Pattern::Chessboard});
  const bool whole = found.seen == kCorners;
  if (found.corners_px.empty())
    throw Error(fmt::format(
        "the card is not seen (expected its {}x{} squares in the light, sharp, each at least {:g} pixels "
        "wide; heel card writes it)",
        kCardColumns, kCardRows, kLeastSquare_px));
  if (!whole)
    throw Error(fmt::format(
        "a part of the card is seen, {}x{} of its {}x{} inner corners (expected all: no finger, no edge of "
        "the picture on a square)",
        found.seen.width, found.seen.height, kCorners.width, kCorners.height));
  return found.corners_px;
}

/// The corners on the card, metres from its middle, in the order of those that are found.
std::vector<cv::Point3d> corners_on_card(double square_m) {
  std::vector<cv::Point3d> points;
  for (int row = 0; row < kCorners.height; ++row)
    for (int column = 0; column < kCorners.width; ++column)
      points.emplace_back((column - (kCorners.width - 1) / 2.0) * square_m,
                          (row - (kCorners.height - 1) / 2.0) * square_m, 0.0);
  return points;
}

std::vector<cv::Point2d> undistorted(const std::vector<cv::Point2f>& points_px, const CameraModel& camera) {
  std::vector<cv::Point2d> straight_px;
  for (const cv::Point2f& point : points_px) {
    const Eigen::Vector2d straight = camera.undistort_px({point.x, point.y});
    straight_px.emplace_back(straight.x(), straight.y());
  }
  return straight_px;
}

}  // namespace

CardDistance distance_of_card(const cv::Mat& grey, const CameraModel& camera, double square_m) {
  const std::vector<cv::Point3d> card_m = corners_on_card(square_m);
  const std::vector<cv::Point2d> seen_px = undistorted(corners_of_card(grey), camera);
  const cv::Matx33d K(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  // A plane has two poses that look nearly alike: solvePnP refines the better one.
  cv::Vec3d rotation, t;
  if (!cv::solvePnP(card_m, seen_px, K, cv::noArray(), rotation, t, false, cv::SOLVEPNP_IPPE) ||
      !cv::solvePnP(card_m, seen_px, K, cv::noArray(), rotation, t, true, cv::SOLVEPNP_ITERATIVE) ||
      !(t[2] > 0.0))
    throw Error("the card is seen, but its corners fit no place in front of the camera");

  std::vector<cv::Point2d> fitted_px;
  cv::Mat jacobian;  // of the corners by rotation and place
  cv::projectPoints(card_m, rotation, t, K, cv::noArray(), fitted_px, jacobian);
  double sum_px2 = 0.0;
  for (std::size_t i = 0; i < fitted_px.size(); ++i) {
    const cv::Point2d off_px = fitted_px[i] - seen_px[i];
    sum_px2 += off_px.dot(off_px);
  }
  constexpr int kUnknowns = 6;
  CardDistance card;
  card.distance_m = t[2];
  card.rms_px = std::sqrt(sum_px2 / (2.0 * static_cast<double>(seen_px.size()) - kUnknowns));
  const cv::Mat by_pose = jacobian.colRange(0, kUnknowns);
  const cv::Mat normal = by_pose.t() * by_pose;
  const double z_per_px = std::sqrt(cv::Mat(normal.inv(cv::DECOMP_SVD)).at<double>(5, 5));
  card.sigma_m = std::hypot(z_per_px * std::max(card.rms_px, kLeastSigma_px), kScaleSigma * card.distance_m);
  cv::Matx33d R;
  cv::Rodrigues(rotation, R);
  card.tilt_rad =
      std::acos(std::min(1.0, std::abs(cv::Vec3d(R(0, 2), R(1, 2), R(2, 2)).dot(t)) / cv::norm(t)));

  const double most_rms_px = std::max(kMostRms_px, kMostRmsOfSquare * camera.fx * square_m / card.distance_m);
  if (card.rms_px > most_rms_px)
    throw Error(
        fmt::format("the card's corners are {:.1f} pixels from those of a flat card (expected at most "
                    "{:.1f}: it is bent, or "
                    "the camera file is of another camera)",
                    card.rms_px, most_rms_px));
  if (card.tilt_rad * kDegPerRad > kMostTilt_deg)
    throw Error(
        fmt::format("the card is turned by {:.0f}° from the line of sight (expected at most {:g}°: the back "
                    "square to the camera, the card flat against it and printed in proportion)",
                    card.tilt_rad * kDegPerRad, kMostTilt_deg));
  return card;
}

}  // namespace heel::cli
