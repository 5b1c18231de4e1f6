#include "vision/template/turned_template.h"

#include <cmath>
#include <utility>
#include <vector>

namespace heel {
namespace {

CameraModel mirrored(CameraModel camera) {
  camera.cx = camera.width_px - 1 - camera.cx;
  camera.p2 = -camera.p2;
  return camera;
}

/// A quarter clockwise: (x, y) goes to (-y, x).
CameraModel turned_by_quarter(CameraModel camera) {
  const double cx_px = camera.cx, p1 = camera.p1;
  camera.cx = camera.height_px - 1 - camera.cy;
  camera.cy = cx_px;
  camera.p1 = camera.p2;
  camera.p2 = -p1;
  std::swap(camera.width_px, camera.height_px);
  std::swap(camera.fx, camera.fy);
  return camera;
}

Region turned_region(Region region, int width_px, int height_px, const PictureTurn& turn) {
  if (turn.mirror) region.x_px = width_px - region.x_px - region.width_px;
  for (int i = 0; i < turn.quarters; ++i) {
    region = {height_px - region.y_px - region.height_px, region.x_px, region.height_px, region.width_px};
    std::swap(width_px, height_px);
  }
  return region;
}

/// From the camera's axes to those of the camera that would take the turned pictures.
Eigen::Matrix3d R_turned_from_camera(const PictureTurn& turn) {
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity(), quarter;
  if (turn.mirror) mirror(0, 0) = -1.0;
  quarter << 0, -1, 0,  //
      1, 0, 0,          //
      0, 0, 1;
  Eigen::Matrix3d R = mirror;
  for (int i = 0; i < turn.quarters; ++i) R = quarter * R;
  return R;
}

std::vector<std::uint8_t> turned_picture(const std::vector<std::uint8_t>& grey, const CameraModel& camera,
                                         const PictureTurn& turn) {
  std::vector<std::uint8_t> turned(grey.size());
  const auto width_px = static_cast<std::uint32_t>(camera.width_px);
  turn_grey(turn, grey.data(), width_px, width_px, static_cast<std::uint32_t>(camera.height_px),
            turned.data());
  return turned;
}

/// A calibration that was read from the same file, written and read again.
bool same_camera(const CameraModel& a, const CameraModel& b) {
  constexpr double kSame_px = 1e-3, kSame = 1e-6;
  return a.width_px == b.width_px && a.height_px == b.height_px && std::abs(a.fx - b.fx) < kSame_px &&
         std::abs(a.fy - b.fy) < kSame_px && std::abs(a.cx - b.cx) < kSame_px &&
         std::abs(a.cy - b.cy) < kSame_px && std::abs(a.k1 - b.k1) < kSame && std::abs(a.k2 - b.k2) < kSame &&
         std::abs(a.p1 - b.p1) < kSame && std::abs(a.p2 - b.p2) < kSame && std::abs(a.k3 - b.k3) < kSame &&
         a.lens == b.lens && std::abs(a.k4 - b.k4) < kSame && std::abs(a.k5 - b.k5) < kSame &&
         std::abs(a.k6 - b.k6) < kSame;
}

}  // namespace

CameraModel turned_camera(const CameraModel& camera, const PictureTurn& turn) {
  CameraModel turned = turn.mirror ? mirrored(camera) : camera;
  for (int i = 0; i < turn.quarters; ++i) turned = turned_by_quarter(turned);
  return turned;
}

ShirtTemplate turned_template(const ShirtTemplate& shirt, const PictureTurn& turn) {
  ShirtTemplate turned = shirt;
  const Eigen::Matrix3d R = R_turned_from_camera(turn);
  turned.upright = true;
  turned.grey = turned_picture(shirt.grey, shirt.camera, turn);
  turned.camera = turned_camera(shirt.camera, turn);
  turned.roi = turned_region(shirt.roi, shirt.camera.width_px, shirt.camera.height_px, turn);
  if (turn.mirror) turned.yaw_rad = -shirt.yaw_rad;
  for (FurtherView& view : turned.further_views) {
    view.grey = turned_picture(view.grey, shirt.camera, turn);
    view.R_further_from_ref = R * view.R_further_from_ref * R.transpose();
    view.t_over_d = R * view.t_over_d;
  }
  return turned;
}

TurnedTemplates templates_for_turned(std::span<const ShirtTemplate> shirts, const CameraModel& camera,
                                     const PictureTurn& turn) {
  TurnedTemplates all;
  const auto may_be_sent = [&](const ShirtTemplate& shirt) {
    return turn.any() && !shirt.upright && same_camera(shirt.camera, camera);
  };
  for (std::size_t i = 0; i < shirts.size(); ++i) {
    all.shirts.push_back(may_be_sent(shirts[i]) ? turned_template(shirts[i], turn) : shirts[i]);
    all.taught.push_back(i);
  }
  for (std::size_t i = 0; i < shirts.size(); ++i) {
    // Poses by several templates are compared in metres.
    if (!may_be_sent(shirts[i]) || shirts[i].distance_m <= 0.0) continue;
    all.shirts.push_back(shirts[i]);
    all.shirts.back().is_first = i == 0;
    all.taught.push_back(i);
  }
  return all;
}

}  // namespace heel
