// The camera of turned pictures sees each point where the turned picture shows it.
#include "vision/template/turned_template.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <vector>

namespace heel {
namespace {

CameraModel lens() {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.fx = 550.0;
  camera.fy = 540.0;
  camera.cx = 325.0;
  camera.cy = 230.0;
  camera.k1 = -0.2;
  camera.k2 = 0.05;
  camera.p1 = 0.004;
  camera.p2 = -0.003;
  camera.k3 = 0.01;
  return camera;
}

Eigen::Vector2d seen_px(const CameraModel& camera, const Eigen::Vector3d& point) {
  return camera.distort_px((camera.K() * (point / point.z())).head<2>());
}

const std::vector<PictureTurn> kTurns{picture_turn(0, true),    picture_turn(90, false),
                                      picture_turn(180, false), picture_turn(270, false),
                                      picture_turn(90, true),   picture_turn(270, true)};

/// A point of the scene from the turned camera's axes, and a pixel of the turned picture.
Eigen::Vector3d turned_point(Eigen::Vector3d point, const PictureTurn& turn) {
  if (turn.mirror) point.x() = -point.x();
  for (int i = 0; i < turn.quarters; ++i) point = {-point.y(), point.x(), point.z()};
  return point;
}
Eigen::Vector2d turned_pixel(Eigen::Vector2d px, int width_px, int height_px, const PictureTurn& turn) {
  if (turn.mirror) px.x() = width_px - 1 - px.x();
  for (int i = 0; i < turn.quarters; ++i) {
    px = {height_px - 1 - px.y(), px.x()};
    std::swap(width_px, height_px);
  }
  return px;
}

TEST(TurnedCamera, SeesEachPointWhereTheTurnedPictureShowsIt) {
  const CameraModel camera = lens();
  for (const PictureTurn& turn : kTurns) {
    const CameraModel turned = turned_camera(camera, turn);
    for (const Eigen::Vector3d& point : {Eigen::Vector3d(0.3, -0.2, 1.0), Eigen::Vector3d(-0.5, 0.35, 1.2),
                                         Eigen::Vector3d(0.1, 0.4, 2.0)}) {
      const Eigen::Vector2d expected =
          turned_pixel(seen_px(camera, point), camera.width_px, camera.height_px, turn);
      EXPECT_LT((seen_px(turned, turned_point(point, turn)) - expected).norm(), 1e-9)
          << turn.quarters << ' ' << turn.mirror;
    }
  }
}

ShirtTemplate taught() {
  ShirtTemplate shirt;
  shirt.camera = lens();
  shirt.grey.assign(640 * 480, 10);
  shirt.roi = {100, 50, 30, 20};
  shirt.grey[640 * 50 + 100] = 200;  // the region's first pixel
  shirt.yaw_rad = 0.4;
  FurtherView view;
  view.grey = shirt.grey;
  view.R_further_from_ref =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(0.1, 0.9, 0.2).normalized()).toRotationMatrix();
  view.t_over_d = {0.1, -0.2, 0.3};
  shirt.further_views.push_back(view);
  return shirt;
}

TEST(TurnedTemplate, KeepsItsRegionAndTheMotionOfItsViews) {
  const ShirtTemplate shirt = taught();
  for (const PictureTurn& turn : kTurns) {
    const ShirtTemplate turned = turned_template(shirt, turn);
    const Eigen::Vector2d first = turned_pixel({100, 50}, 640, 480, turn);
    const auto x_px = static_cast<int>(first.x()), y_px = static_cast<int>(first.y());
    EXPECT_EQ(turned.grey[static_cast<std::size_t>(y_px * turned.camera.width_px + x_px)], 200);
    const Region& roi = turned.roi;
    EXPECT_EQ(roi.width_px * roi.height_px, 600);
    EXPECT_TRUE(x_px == roi.x_px || x_px == roi.x_px + roi.width_px - 1) << x_px;
    EXPECT_TRUE(y_px == roi.y_px || y_px == roi.y_px + roi.height_px - 1) << y_px;
    // X_further / d = R X_ref / d + t holds in the turned axes.
    const Eigen::Vector3d point(0.2, 0.1, 1.0);
    const FurtherView& before = shirt.further_views[0];
    const FurtherView& after = turned.further_views[0];
    const Eigen::Vector3d moved = before.R_further_from_ref * point + before.t_over_d;
    EXPECT_LT(
        (after.R_further_from_ref * turned_point(point, turn) + after.t_over_d - turned_point(moved, turn))
            .norm(),
        1e-12);
    EXPECT_NEAR(after.R_further_from_ref.determinant(), 1.0, 1e-12);
  }
}

/// Where the regions of the templates begin.
std::vector<int> left_edges_px(const TurnedTemplates& templates) {
  std::vector<int> edges_px;
  for (const ShirtTemplate& shirt : templates.shirts) edges_px.push_back(shirt.roi.x_px);
  return edges_px;
}

TEST(TurnedTemplate, OnlyOneThatMayBeTaughtFromWhatThisCameraSendsIsTurned) {
  const PictureTurn turn = picture_turn(180, false);
  const CameraModel camera = lens();
  ShirtTemplate unsaid = taught();
  unsaid.distance_m = 1.5;
  ShirtTemplate other = unsaid;
  other.camera.fx = 800.0;  // a photograph by another camera
  ShirtTemplate upright = unsaid;
  upright.upright = true;
  using testing::ElementsAre;
  EXPECT_THAT(left_edges_px(templates_for_turned({{other, upright}}, camera, turn)), ElementsAre(100, 100));
  EXPECT_THAT(left_edges_px(templates_for_turned({{unsaid, other}}, camera, {})), ElementsAre(100, 100));
  // As it is, it stands behind the others.
  constexpr int kTurned_px = 640 - 100 - 30;
  const TurnedTemplates both = templates_for_turned({{other, unsaid, upright}}, camera, turn);
  EXPECT_THAT(left_edges_px(both), ElementsAre(100, kTurned_px, 100, 100));
  EXPECT_THAT(both.taught, ElementsAre(0U, 1U, 2U, 1U));
  EXPECT_FALSE(both.shirts[3].upright);
  EXPECT_FALSE(both.shirts[3].is_first) << "the first one is as it is";
  const TurnedTemplates guesses = templates_for_turned({{unsaid, unsaid}}, camera, turn);
  EXPECT_THAT(left_edges_px(guesses), ElementsAre(kTurned_px, kTurned_px, 100, 100));
  EXPECT_TRUE(guesses.shirts[2].is_first && !guesses.shirts[0].is_first && !guesses.shirts[3].is_first);
  // Without a distance, two poses cannot be compared.
  EXPECT_THAT(left_edges_px(templates_for_turned({{taught()}}, camera, turn)), ElementsAre(kTurned_px));
}

}  // namespace
}  // namespace heel
