#include "vision/homography/shape_plausibility.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "vision/pose/scene.h"

namespace heel {
namespace {

const Outline kOutline = {Eigen::Vector2d(220, 90), {420, 90}, {420, 390}, {220, 390}};

Eigen::Matrix3d scaling(double x, double y) {
  return Eigen::DiagonalMatrix<double, 3>(x, y, 1.0);
}

TEST(ShapePlausibility, EveryViewOfTheShirtIsPlausible) {
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    test::Random random(seed);
    const test::View view = test::random_view(random, test::plain_camera(), 1.1);
    EXPECT_TRUE(plausible_shape(view.H, kOutline, ShapeLimits{})) << "seed " << seed;
    EXPECT_TRUE(plausible_shape(-view.H, kOutline, ShapeLimits{})) << "seed " << seed;
  }
}

TEST(ShapePlausibility, SizeHasBounds) {
  EXPECT_TRUE(plausible_shape(scaling(0.11, 0.11), kOutline, ShapeLimits{}));
  EXPECT_FALSE(plausible_shape(scaling(0.09, 0.09), kOutline, ShapeLimits{}));
  EXPECT_TRUE(plausible_shape(scaling(9.0, 9.0), kOutline, ShapeLimits{}));
  EXPECT_FALSE(plausible_shape(scaling(11.0, 11.0), kOutline, ShapeLimits{}));
}

TEST(ShapePlausibility, SqueezedMirroredAndFoldedAreRefused) {
  EXPECT_TRUE(plausible_shape(scaling(0.25, 1.0), kOutline, ShapeLimits{}));
  EXPECT_FALSE(plausible_shape(scaling(0.15, 1.0), kOutline, ShapeLimits{}));
  EXPECT_FALSE(plausible_shape(scaling(-1.0, 1.0), kOutline, ShapeLimits{}));
  Eigen::Matrix3d horizon_through_it = Eigen::Matrix3d::Identity();
  horizon_through_it.row(2) << 1.0 / 320.0, 0.0, -1.0;
  EXPECT_FALSE(plausible_shape(horizon_through_it, kOutline, ShapeLimits{}));
  Eigen::Matrix3d steep = Eigen::Matrix3d::Identity();
  steep.row(2) << 0.0, 1.0 / 100.0, -0.4;  // depths 0.5 … 3.5
  EXPECT_FALSE(plausible_shape(steep, kOutline, ShapeLimits{}));
  EXPECT_FALSE(plausible_shape(Eigen::Matrix3d::Zero(), kOutline, ShapeLimits{}));
  Eigen::Matrix3d rank_two = Eigen::Matrix3d::Identity();
  rank_two(0, 0) = 0.0;
  EXPECT_FALSE(plausible_shape(rank_two, kOutline, ShapeLimits{}));
}

TEST(ShapePlausibility, LocalScaleIsTheMagnification) {
  EXPECT_NEAR(local_scale(scaling(2.0, 8.0), {100, 100}), 4.0, 1e-12);
  // Compared with a small square, mapped point by point.
  test::Random random(9);
  const Eigen::Matrix3d H = test::random_view(random, test::plain_camera()).H;
  const Eigen::Vector2d at(300, 200), dx(1e-3, 0), dy(0, 1e-3);
  const Eigen::Vector2d u = test::mapped(H, at + dx) - test::mapped(H, at - dx);
  const Eigen::Vector2d v = test::mapped(H, at + dy) - test::mapped(H, at - dy);
  EXPECT_NEAR(local_scale(H, at), std::sqrt(u.x() * v.y() - u.y() * v.x()) / 2e-3, 1e-6);
}

}  // namespace
}  // namespace heel
