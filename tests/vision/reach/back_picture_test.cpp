// A made picture shows each place of the print where the camera would see it.
#include "vision/reach/back_picture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "vision/pose/average_back.h"
#include "vision/pose/rendered_shirt.h"
#include "vision/pose/scene.h"

namespace heel {
namespace {

constexpr float kBackground = 7.f;

std::vector<float> empty_frame(const CameraModel& camera) {
  return std::vector<float>(
      static_cast<std::size_t>(camera.width_px) * static_cast<std::size_t>(camera.height_px), kBackground);
}

float at(const std::vector<float>& frame, const CameraModel& camera, const Eigen::Vector2d& px) {
  return frame[static_cast<std::size_t>(std::lround(px.y()) * camera.width_px + std::lround(px.x()))];
}

/// A shirt that is black but for white discs, and where they are in the template's picture.
struct DottedShirt {
  DottedShirt() {
    shirt = test::shirt();
    cv::Mat image(shirt.camera.height_px, shirt.camera.width_px, CV_8U, shirt.grey.data());
    image = cv::Scalar(20);
    for (int x = 250; x <= 390; x += 35)
      for (int y = 140; y <= 340; y += 50) dots_px.emplace_back(x, y);
    for (const Eigen::Vector2d& px : dots_px)
      cv::circle(image, {static_cast<int>(px.x()), static_cast<int>(px.y())}, 9, cv::Scalar(220), cv::FILLED);
    surface = average_back(ReferenceView(test::shirt(), VisionConfig{}), VisionConfig{});
  }
  ShirtTemplate shirt;
  BackSurface surface;
  std::vector<Eigen::Vector2d> dots_px;
};

TEST(BackPicture, FromTheTemplatesPlaceItIsTheTemplatesPicture) {
  const ShirtTemplate shirt = test::shirt();
  const BackSurface surface = average_back(ReferenceView(shirt, VisionConfig{}), VisionConfig{});
  std::vector<float> frame = empty_frame(shirt.camera);
  BackPicture(shirt, surface, shirt.camera).draw({}, {}, frame);
  double difference = 0.0;
  for (int y = shirt.roi.y_px; y < shirt.roi.y_px + shirt.roi.height_px; ++y) {
    for (int x = shirt.roi.x_px; x < shirt.roi.x_px + shirt.roi.width_px; ++x) {
      const auto i = static_cast<std::size_t>(y * shirt.camera.width_px + x);
      difference += std::abs(static_cast<double>(frame[i]) - shirt.grey[i]);
    }
  }
  EXPECT_LT(difference / (shirt.roi.width_px * shirt.roi.height_px), 3.0);
  EXPECT_EQ(frame.front(), kBackground);
  EXPECT_EQ(frame.back(), kBackground);
}

TEST(BackPicture, ATurnedBackShowsItsVisibleDotsWhereTheCameraSeesThem) {
  const DottedShirt dotted;
  const CameraModel camera = test::robot_camera();
  const Eigen::Matrix3d K_ref_inverse = dotted.shirt.camera.K().inverse();
  BackPicture picture(dotted.shirt, dotted.surface, camera);
  for (const double yaw_rad : {-0.9, 0.0, 0.6}) {
    FrontalMotion motion;
    motion.R_cur_from_ref = test::rotation(yaw_rad, 0.0, 0.0);
    motion.t_over_d =
        Eigen::Vector3d(0.1, -0.05, 1.2) -
        motion.R_cur_from_ref * Eigen::Vector3d(dotted.surface.axis_x, dotted.surface.axis_y, 1.0);
    const Eigen::Matrix3d KR = camera.K() * motion.R_cur_from_ref;
    const Eigen::Vector3d Kt = camera.K() * motion.t_over_d;
    std::vector<float> frame = empty_frame(camera);
    picture.draw(motion, {}, frame);
    int visible = 0;
    for (const Eigen::Vector2d& dot_px : dotted.dots_px) {
      const Eigen::Vector3d ray = K_ref_inverse * dotted.shirt.camera.undistort_px(dot_px).homogeneous();
      if (image_derivative(dotted.surface, K_ref_inverse, KR, Kt, ray).determinant() < 0.2) continue;
      const Eigen::Vector2d px = camera.distort_px((KR * dotted.surface.point(ray) + Kt).hnormalized());
      EXPECT_GT(at(frame, camera, px), 180.f) << "yaw " << yaw_rad << ", dot at " << dot_px.transpose();
      ++visible;
    }
    EXPECT_GE(visible, 15) << "yaw " << yaw_rad;
  }
}

TEST(BackPicture, ABackThatShowsItsInsideOrIsBehindTheCameraIsNotDrawn) {
  const DottedShirt dotted;
  const CameraModel& camera = dotted.shirt.camera;
  BackPicture picture(dotted.shirt, dotted.surface, camera);
  FrontalMotion turned_round;
  turned_round.R_cur_from_ref = test::rotation(M_PI, 0.0, 0.0);
  turned_round.t_over_d = {0.0, 0.0, 3.0};
  FrontalMotion behind;
  behind.t_over_d = {0.0, 0.0, -2.0};
  for (const FrontalMotion& motion : {turned_round, behind}) {
    std::vector<float> frame = empty_frame(camera);
    picture.draw(motion, {}, frame);
    EXPECT_EQ(frame, empty_frame(camera));
  }
}

TEST(ClothFolds, MoveACertainPlaceAlongTheNormalByTheSumOfTheirWaves) {
  ClothFolds folds;
  folds.waves[0] = {{M_PI, 0.0}, 0.0, 0.02};
  folds.waves[1] = {{0.0, M_PI}, M_PI / 2.0, 0.01};
  EXPECT_NEAR(folds.at({0.0, 0.0, 1.0}), 0.02, 1e-12);
  EXPECT_NEAR(folds.at({1.0, -0.5, 1.0}), -0.02 + 0.01, 1e-12);
}

}  // namespace
}  // namespace heel
