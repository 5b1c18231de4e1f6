// The surfaces of a template: the average back in the units of the template's distance, and the plane.
#include "vision/pose/average_back.h"

#include <gtest/gtest.h>

#include "vision/pose/rendered_shirt.h"

namespace heel {
namespace {

ReferenceView view_from(double distance_m) {
  ShirtTemplate shirt = test::shirt();
  shirt.distance_m = distance_m;
  return ReferenceView(shirt, VisionConfig{});
}

double depth_m(const BackSurface& surface, double distance_m, double u, double v) {
  return distance_m * surface.depth.at(u, v);
}

// What a tape measure on a person shows, whatever the distance at which the template was taken.
TEST(AverageBack, HasTheDepthsOfABack) {
  for (const double distance_m : {1.0, 2.5}) {
    const BackSurface back = average_back(view_from(distance_m), VisionConfig{});
    EXPECT_EQ(back.depth.at(0.0, 0.0), 0.0);
    for (const double side : {-1.0, 1.0}) {
      EXPECT_GT(depth_m(back, distance_m, side, 0.0), 0.025) << "the sides lie behind the middle";
      EXPECT_LT(depth_m(back, distance_m, side, 0.0), 0.05);
      EXPECT_LT(depth_m(back, distance_m, 0.4 * side, 0.0), 0.001) << "the shoulder blades do not";
    }
    EXPECT_LT(depth_m(back, distance_m, 0.0, 1.0), -0.01) << "the waist is nearer than the middle";
  }
}

TEST(AverageBack, ScalesWithTheConfiguredCurvature) {
  VisionConfig config;
  const ReferenceView view = view_from(1.5);
  const BackSurface average = average_back(view, config);
  config.back_curvature_1_m *= 0.5;
  EXPECT_NEAR(average_back(view, config).depth.at(0.7, -0.3), 0.5 * average.depth.at(0.7, -0.3), 1e-12);
  config.back_curvature_1_m = 0.0;
  EXPECT_TRUE(average_back(view, config).flat());
}

TEST(AverageBack, IsAPlaneWithoutADistance) {
  const BackSurface back = average_back(view_from(0.0), VisionConfig{});
  EXPECT_TRUE(back.flat());
  EXPECT_EQ(back.shape_sigma, 0.0);
  EXPECT_EQ(back.bend_sigma, 0.0);
}

TEST(AverageBack, CoversTheRegionFromEdgeToEdge) {
  const ReferenceView view = view_from(1.5);
  const BackSurface back = average_back(view, VisionConfig{});
  const Eigen::Vector3d corner = view.K_inverse * view.outline_px[0].homogeneous();
  EXPECT_NEAR(back.u(corner), -1.0, 1e-9);
  EXPECT_NEAR(back.v(corner), -1.0, 1e-9);
}

}  // namespace
}  // namespace heel
