// Colours are BGR.
#include "picture.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace heel::cli {
namespace {

const cv::Scalar kFound(80, 220, 60);
const cv::Scalar kMissed(60, 60, 230);
const cv::Scalar kDirection(40, 190, 255);
const cv::Scalar kText(255, 255, 255);
const cv::Scalar kDarkBlob(255, 160, 60);
const cv::Scalar kLightBlob(60, 200, 255);

constexpr int kShift = 4;  // fractional bits of OpenCV's coordinates: a sixteenth of a pixel
cv::Point in_sixteenths(const Eigen::Vector2d& px) {
  constexpr double kFar = 1e5;  // beyond any picture, within int
  return {static_cast<int>(std::lround(std::clamp(px.x(), -kFar, kFar) * (1 << kShift))),
          static_cast<int>(std::lround(std::clamp(px.y(), -kFar, kFar) * (1 << kShift)))};
}

void put_text(cv::Mat& picture, const std::string& text, cv::Point at, const cv::Scalar& colour,
              double scale = 0.5) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar(0, 0, 0), 3, cv::LINE_AA);
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, scale, colour, 1, cv::LINE_AA);
}

/// The outline of the template's region in the current frame. Both lenses distort, so that its edges need not
/// be straight.
std::vector<cv::Point> outline(const PoseEstimate& pose, const ShirtTemplate& shirt,
                               const CameraModel& camera) {
  constexpr int kPointsASide = 12;
  const Region& r = shirt.roi;
  const Eigen::Matrix3d H =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(pose.H_cur_from_ref.data());
  const std::array<Eigen::Vector2d, 5> corners = {
      Eigen::Vector2d(r.x_px, r.y_px), Eigen::Vector2d(r.x_px + r.width_px, r.y_px),
      Eigen::Vector2d(r.x_px + r.width_px, r.y_px + r.height_px),
      Eigen::Vector2d(r.x_px, r.y_px + r.height_px), Eigen::Vector2d(r.x_px, r.y_px)};
  std::vector<cv::Point> points;
  for (std::size_t side = 0; side < 4; ++side) {
    for (int i = 0; i < kPointsASide; ++i) {
      const double share = static_cast<double>(i) / kPointsASide;
      const Eigen::Vector2d ref_px = (1.0 - share) * corners[side] + share * corners[side + 1];
      const Eigen::Vector3d cur = H * shirt.camera.undistort_px(ref_px).homogeneous();
      points.push_back(in_sixteenths(camera.distort_px(cur.hnormalized())));
    }
  }
  return points;
}

/// A view from above: the camera at the bottom, the back as a bar, the walking direction as an arrow. The
/// square is three times as wide as the reference distance.
void draw_from_above(cv::Mat& picture, const PoseEstimate& pose) {
  const int side = std::clamp(picture.rows / 4, 60, 200);
  const cv::Rect frame(picture.cols - side - 8, 8, side, side);
  cv::Mat square = picture(frame);
  square *= 0.35;
  cv::rectangle(picture, frame, cv::Scalar(160, 160, 160), 1);

  const cv::Point2d camera(side / 2.0, side * 0.93);
  const double scale = side / 3.0;
  const cv::Point2d back(camera.x + scale * pose.t_over_d[0], camera.y - scale * (1.0 + pose.t_over_d[2]));
  const cv::Point2d direction(std::sin(pose.yaw_rad), -std::cos(pose.yaw_rad));
  const cv::Point2d across(-direction.y, direction.x);
  const double half = side * 0.10;
  cv::line(square, back - half * across, back + half * across, kFound, 3, cv::LINE_AA);
  cv::arrowedLine(square, back, back + 2.2 * half * direction, kDirection, 2, cv::LINE_AA, 0, 0.35);
  const std::vector<cv::Point> cone = {
      camera, {side / 2 - side / 12, side - side / 6}, {side / 2 + side / 12, side - side / 6}};
  cv::fillConvexPoly(square, cone, cv::Scalar(200, 200, 200), cv::LINE_AA);
}

std::string pose_text(const PoseEstimate& pose) {
  const std::string text =
      fmt::format("certainty {:.2f}  yaw {:+.0f} +- {:.0f} deg", pose.certainty,
                  pose.yaw_rad * 180.0 / std::numbers::pi, pose.yaw_sigma_rad * 180.0 / std::numbers::pi);
  if (pose.has_distance)
    return text + fmt::format("  x {:+.2f}  z {:.2f} m", pose.position_m[0], pose.position_m[2]);
  return text + fmt::format("  x/d {:+.2f}  z/d {:.2f}", pose.t_over_d[0], 1.0 + pose.t_over_d[2]);
}

}  // namespace

cv::Mat draw_pose(const cv::Mat& grey, const PoseEstimate& pose, const ShirtTemplate& shirt,
                  const CameraModel& camera) {
  cv::Mat picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  const cv::Point corner(10, picture.rows - 12);
  if (!pose.found()) {
    put_text(picture, std::string("not found: ") + to_string(pose.reason), corner, kMissed);
    return picture;
  }
  cv::polylines(picture, std::vector<std::vector<cv::Point>>{outline(pose, shirt, camera)}, true, kFound, 2,
                cv::LINE_AA, kShift);
  draw_from_above(picture, pose);
  put_text(picture, pose_text(pose), corner, kText);
  return picture;
}

cv::Mat draw_template(const ShirtTemplate& shirt, const FeatureSet& features) {
  const cv::Mat grey(shirt.camera.height_px, shirt.camera.width_px, CV_8UC1,
                     const_cast<std::uint8_t*>(shirt.grey.data()));
  const Region& r = shirt.roi;
  const int margin = std::max(r.width_px, r.height_px) / 4;
  const cv::Rect cut =
      cv::Rect(r.x_px - margin, r.y_px - margin, r.width_px + 2 * margin, r.height_px + 2 * margin) &
      cv::Rect(0, 0, grey.cols, grey.rows);
  const double zoom = std::max(1.0, 720.0 / cut.height);

  cv::Mat enlarged;
  cv::resize(grey(cut), enlarged, {}, zoom, zoom, cv::INTER_CUBIC);
  cv::Mat picture;
  cv::cvtColor(enlarged, picture, cv::COLOR_GRAY2BGR);
  const auto place = [&](double x_px, double y_px) {
    return in_sixteenths({(x_px - cut.x + 0.5) * zoom - 0.5, (y_px - cut.y + 0.5) * zoom - 0.5});
  };
  cv::rectangle(picture, place(r.x_px, r.y_px), place(r.x_px + r.width_px, r.y_px + r.height_px), kFound, 2,
                cv::LINE_AA, kShift);
  for (const Feature& feature : features.features) {
    const int radius = static_cast<int>(std::lround(2.0 * feature.sigma_px * zoom * (1 << kShift)));
    cv::circle(picture, place(feature.x_px, feature.y_px), radius,
               feature.laplacian > 0 ? kDarkBlob : kLightBlob, 1, cv::LINE_AA, kShift);
  }
  return picture;
}

}  // namespace heel::cli
