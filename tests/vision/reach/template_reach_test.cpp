// A bold print reaches farther than a pale one, and what is little about a reach is said.
#include "vision/reach/template_reach.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "heel/error.h"
#include "support/sanitized.h"
#include "vision/pose/rendered_shirt.h"

namespace heel {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

bool go_on(int, int) {
  return true;
}

/// A print of 40 cm × 56 cm, taught from 1.5 m; `contrast` 1 is black on white.
ShirtTemplate printed(double contrast) {
  ShirtTemplate shirt;
  shirt.camera = test::plain_camera();
  cv::Mat image = test::texture(11, shirt.camera.width_px, shirt.camera.height_px);
  image.convertTo(image, CV_8U, contrast, 128.0 * (1.0 - contrast));
  shirt.grey.assign(image.datastart, image.dataend);
  shirt.roi = {240, 130, 160, 224};
  shirt.distance_m = 1.5;
  return shirt;
}

TemplateReach reach_of(const ShirtTemplate& shirt) {
  return measure_reach(shirt, shirt.camera, VisionConfig{}, go_on);
}

TEST(TemplateReach, ABoldPrintReachesFartherThanAPaleOne) {
  if (test::kSanitized) GTEST_SKIP() << "the tests below run the same code for a shorter time";
  const TemplateReach bold = reach_of(printed(1.0)), pale = reach_of(printed(0.15));
  EXPECT_TRUE(bold.complete);
  EXPECT_LE(bold.near_m, 1.0);
  EXPECT_GE(bold.far_m, 3.0);
  ASSERT_TRUE(bold.turn_rad);
  EXPECT_GE(*bold.turn_rad, M_PI / 4.0);
  EXPECT_THAT(reach_warning(bold), IsEmpty());

  EXPECT_LT(pale.far_m, bold.far_m);
  EXPECT_LT(pale.turn_rad.value_or(0.0), *bold.turn_rad);
  EXPECT_THAT(reach_warning(pale), HasSubstr("the print is small or low in contrast"));
}

TEST(TemplateReach, ACameraWithFewerPixelsReachesLessFar) {
  const ShirtTemplate shirt = printed(1.0);
  CameraModel small = shirt.camera;
  small.width_px /= 4;
  small.height_px /= 4;
  small.fx /= 4.0;
  small.fy /= 4.0;
  small.cx /= 4.0;
  small.cy /= 4.0;
  const TemplateReach reach = measure_reach(shirt, small, VisionConfig{}, go_on);
  EXPECT_LT(reach.far_m, 2.5);
  EXPECT_THAT(reach_warning(reach), HasSubstr("before 3 m"));
}

TEST(TemplateReach, MeasuresTheSamePicturesEachTime) {
  const ShirtTemplate shirt = printed(0.15);
  const auto first_three_cells = [](int done, int) { return done < 12; };
  const TemplateReach a = measure_reach(shirt, shirt.camera, VisionConfig{}, first_three_cells);
  const TemplateReach b = measure_reach(shirt, shirt.camera, VisionConfig{}, first_three_cells);
  ASSERT_EQ(a.cells.size(), 3U);
  ASSERT_EQ(b.cells.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(a.cells[i].found, b.cells[i].found) << i;
}

TEST(TemplateReach, EndsWhenItIsToldToAndWarnsOfNothingThatItHasNotMeasured) {
  const ShirtTemplate shirt = printed(1.0);
  int called = 0, most = 0;
  const TemplateReach reach =
      measure_reach(shirt, shirt.camera, VisionConfig{}, [&](int done, int most_pictures) {
        ++called;
        EXPECT_EQ(done, called);
        most = most_pictures;
        return done < 8;
      });
  EXPECT_EQ(called, 8);
  EXPECT_GT(most, 8);
  EXPECT_FALSE(reach.complete);
  EXPECT_EQ(reach.cells.size(), 2U);
  EXPECT_FALSE(reach.turn_rad);
  EXPECT_THAT(reach_warning(reach), IsEmpty());
}

TEST(TemplateReach, ATemplateWithoutDistanceIsRefused) {
  ShirtTemplate shirt = printed(1.0);
  shirt.distance_m = 0.0;
  EXPECT_THROW(reach_of(shirt), Error);
}

TEST(ReachWarning, NamesWhatIsLittle) {
  TemplateReach reach;
  reach.complete = true;
  reach.near_m = 0.8;
  reach.far_m = 3.0;
  reach.turn_rad = M_PI / 4.0;
  EXPECT_THAT(reach_warning(reach), IsEmpty());
  reach.turn_rad = M_PI / 6.0;
  EXPECT_THAT(reach_warning(reach), HasSubstr("it is lost before it turns by 40°"));
  reach.far_m = 2.5;
  EXPECT_THAT(reach_warning(reach), HasSubstr("before 3 m and before it turns by 40°"));
  reach.turn_rad = M_PI / 4.0;
  EXPECT_THAT(reach_warning(reach), HasSubstr("it is lost before 3 m ("));
  reach.complete = false;
  EXPECT_THAT(reach_warning(reach), IsEmpty());
}

}  // namespace
}  // namespace heel
