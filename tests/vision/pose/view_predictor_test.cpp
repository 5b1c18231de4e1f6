// Where in a frame the template can be: the parts that are searched in turn, and how many features a frame
// has.
#include "vision/pose/view_predictor.h"

#include <gtest/gtest.h>

#include "vision/features/upsampled_region.h"
#include "vision/pose/rendered_shirt.h"

namespace heel {
namespace {

CameraModel camera_of(int width_px, int height_px) {
  CameraModel camera = test::robot_camera();
  camera.width_px = width_px;
  camera.height_px = height_px;
  return camera;
}

TEST(ViewPredictor, PartsCoverTheFrameAndOverlapByMoreThanASmallBack) {
  const ReferenceView reference(test::shirt(), VisionConfig{});
  for (const CameraModel& camera : {camera_of(640, 480), camera_of(1920, 1080), camera_of(1280, 720)}) {
    const ViewPredictor predictor(reference, camera, VisionConfig{}, FeatureSettings{});
    const UpsampledRegion upsampled(camera.width_px,
                                    static_cast<std::size_t>(camera.width_px * camera.height_px));
    // A back a seventh of the frame high lies inside of one part, wherever it is.
    const int side_px = camera.height_px / 7;
    for (int y = 0; y + side_px <= camera.height_px; y += 10) {
      for (int x = 0; x + side_px <= camera.width_px; x += 10) {
        bool inside = false;
        for (int i = 0; i < ViewPredictor::kParts; ++i) {
          const Region part = predictor.upsampled_part(i).region;
          inside = inside || (x >= part.x_px && y >= part.y_px && x + side_px <= part.x_px + part.width_px &&
                              y + side_px <= part.y_px + part.height_px);
        }
        ASSERT_TRUE(inside) << x << ", " << y;
      }
    }
    for (int i = 0; i < ViewPredictor::kParts; ++i) {
      const ExpectedView part = predictor.upsampled_part(i);
      EXPECT_TRUE(part.upsample);
      EXPECT_LE(part.sigma_min_px, part.sigma_max_px);
      Region with_border = part.region;
      with_border.width_px += 2 * UpsampledRegion::kBorder_px;
      with_border.height_px += 2 * UpsampledRegion::kBorder_px;
      EXPECT_TRUE(upsampled.has_room_for(with_border)) << i;
    }
  }
}

TEST(FrameFeatureBudget, GrowsWithTheWidthOfThePicture) {
  VisionConfig config;
  config.max_features = 1000;
  EXPECT_EQ(frame_feature_budget(camera_of(640, 480), config), 1000);
  EXPECT_EQ(frame_feature_budget(camera_of(320, 240), config), 1000);
  EXPECT_EQ(frame_feature_budget(camera_of(1920, 1080), config), 3000);
}

}  // namespace
}  // namespace heel
