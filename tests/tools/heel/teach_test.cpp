// heel teach: what it says of a shirt, what it keeps in the template, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/shirt_template.h"
#include "support/sanitized.h"
#include "support/test_data.h"
#include "tools/heel/printed_shirt.h"
#include "tools/heel/taught_shirt.h"

namespace heel {
namespace {

using test::Outcome;
using test::run_heel;
using test::TrueMotion;
using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

using Teach = test::TaughtShirt;

TEST_F(Teach, TeachReportsTheQualityAndKeepsTheOptions) {
  const std::string picture = folder.file("verdict.png");
  const Outcome outcome = teach({"--picture", picture, "--oriented", "--max", "150"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("150 features in the 160 x 200 px region"),
                                 HasSubstr("twice the distance"), HasSubstr("wrote " + shirt)));
  EXPECT_FALSE(cv::imread(picture).empty());

  const ShirtTemplate kept = read_template(shirt);
  EXPECT_EQ(kept.roi.x_px, 240);
  EXPECT_EQ(kept.roi.y_px, 140);
  EXPECT_EQ(kept.roi.width_px, 160);
  EXPECT_EQ(kept.roi.height_px, 200);
  EXPECT_EQ(kept.distance_m, 1.5);
  EXPECT_TRUE(kept.oriented);
  EXPECT_EQ(kept.max_features, 150);
  EXPECT_EQ(kept.camera.fx, 610.0);
  EXPECT_TRUE(std::equal(kept.grey.begin(), kept.grey.end(), reference.datastart, reference.dataend));
}

TEST_F(Teach, TeachSaysFromWhereTheShirtWillBeFound) {
  if (test::kSanitized) GTEST_SKIP() << "with a small camera the same code runs for a shorter time";
  const Outcome bold = teach(test::kNoHurry);
  ASSERT_EQ(bold.status, 0) << bold.err;
  EXPECT_THAT(bold.out,
              ContainsRegex("\nfound from [0-9.]+ to [3-6][0-9.]* m facing away, to [4-7][0-9]° at 2 m"));
  EXPECT_THAT(bold.out, ContainsRegex("\n +0° +[0-4]/4"));
  EXPECT_THAT(bold.out, Not(HasSubstr("warning")));
}

TEST_F(Teach, TeachEndsItsMeasurementInTimeAndSaysSo) {
  const Outcome hurried = teach({"--reach-time", "0.001"});
  ASSERT_EQ(hurried.status, 0) << hurried.err;
  EXPECT_THAT(hurried.out, HasSubstr(" (not measured further after 0.001 s: --reach-time)\n"));
  EXPECT_THAT(hurried.out, Not(HasSubstr("warning")));
  const Outcome none = teach({"--reach-time", "0"});
  ASSERT_EQ(none.status, 0) << none.err;
  EXPECT_THAT(none.out, AllOf(HasSubstr("wrote "), Not(HasSubstr("facing away"))));
}

TEST_F(Teach, TeachMeasuresForTheRobotsCameraAndWarnsWhenItSeesLittle) {
  CameraModel small = test::shirt_camera();
  small.width_px = 160;
  small.height_px = 120;
  for (double* value : {&small.fx, &small.fy, &small.cx, &small.cy}) *value /= 4.0;
  const std::string robot = folder.file("robot.yaml");
  write_camera_model(small, robot);
  const Outcome outcome = teach({"--robot-camera-info", robot, test::kNoHurry[0], test::kNoHurry[1]});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("\nwarning: the print is small or low in contrast: it is lost before 3 m"));
  EXPECT_EQ(read_template(shirt).camera.width_px, test::kWidth_px);
}

TEST_F(Teach, TeachKeepsFurtherPicturesWithThePosesItFindsInThem) {
  const std::string turned = folder.file("turned.png"), far = folder.file("far.png");
  cv::imwrite(turned, TrueMotion{0.5, {0, 0, 0}}.picture(reference));
  cv::imwrite(far, TrueMotion{-0.2, {0.1, 0, 0.3}}.picture(reference));
  const Outcome outcome = teach({"--more", turned, far});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const ShirtTemplate kept = read_template(shirt);
  ASSERT_EQ(kept.further_views.size(), 2u);
  const Eigen::Matrix3d& R = kept.further_views[0].R_further_from_ref;
  EXPECT_NEAR(std::atan2(R(0, 2), R(2, 2)), 0.5, 0.1);
  const cv::Mat picture = cv::imread(far, cv::IMREAD_GRAYSCALE);
  EXPECT_TRUE(std::equal(picture.datastart, picture.dataend, kept.further_views[1].grey.begin(),
                         kept.further_views[1].grey.end()));
  EXPECT_THAT(pose({turned}).err, HasSubstr("found in 1 of 1"));
}

TEST_F(Teach, TeachRefusesAFurtherPictureWithoutTheShirtByItsName) {
  const std::string turned = folder.file("turned.png"), wall = folder.file("wall.png");
  cv::imwrite(turned, TrueMotion{0.3, {0, 0, 0}}.picture(reference));
  cv::imwrite(wall, cv::Mat(test::kHeight_px, test::kWidth_px, CV_8UC1, cv::Scalar(120)));
  const Outcome outcome = teach({"--more", turned, wall});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err, "heel teach: --more " + wall + ": the shirt is not found: too few features\n");
  EXPECT_FALSE(std::filesystem::exists(shirt));
}

TEST_F(Teach, TeachGivesTheSameTemplateThroughACameraAddress) {
  ASSERT_EQ(teach().status, 0);
  const std::string by_camera = folder.file("camera.heel");
  const Outcome outcome = run_heel({"teach", "--camera", "file:" + image, "--roi", test::kRoi, "--distance",
                                    "1.5", "--camera-info", camera, "-o", by_camera});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(test::read_text(by_camera), test::read_text(shirt));
}

/// The report of exif3.jpg: one photo gave two different templates.
TEST_F(Teach, OnePhotoGivesOneTemplateHoweverItIsGiven) {
  HEEL_NEEDS_TEST_DATA("reports");
  const std::string reports = test::data_path("reports/");
  const auto teach_photo = [&](const char* option, const std::string& photo, const std::string& output) {
    return run_heel({"teach", option, photo, "--roi", test::kRoi, "--distance", "1.5", "--reach-time", "0",
                     "--camera-info", reports + "common/camera.yaml", "-o", output});
  };
  const std::string photo = reports + "photo-exif/exif3.jpg", second = folder.file("second.heel");
  ASSERT_EQ(teach_photo("--image", photo, shirt).status, 0);
  ASSERT_EQ(teach_photo("--camera", "file:" + photo, second).status, 0);
  EXPECT_EQ(test::read_text(shirt), test::read_text(second));
  const Outcome cut = teach_photo("--image", reports + "jpeg-cut-short/cut.jpg", folder.file("cut.heel"));
  EXPECT_EQ(cut.status, 2);
  EXPECT_THAT(cut.err, AllOf(HasSubstr("cut.jpg: not a whole image"), ::testing::EndsWith("pixel)\n")));
  EXPECT_FALSE(std::filesystem::exists(folder.file("cut.heel")));
  const Outcome deep =
      teach_photo("--image", reports + "picture-12-bit/mono12_in16.png", folder.file("deep.heel"));
  EXPECT_EQ(deep.status, 0);
  EXPECT_THAT(deep.err, HasSubstr("of which 12 are used"));
}

TEST_F(Teach, TeachRefusesAPlainShirtWithTheReasonAndStatusOne) {
  cv::imwrite(image, cv::Mat(test::kHeight_px, test::kWidth_px, CV_8UC1, cv::Scalar(120)));
  const Outcome outcome = teach();
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("refused: only 0 features: the shirt is too plain"));
  EXPECT_FALSE(std::filesystem::exists(shirt));
}

}  // namespace
}  // namespace heel
