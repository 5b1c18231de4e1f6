// heel pose, on pictures with known truth, by a template of heel teach.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/template_file.h"
#include "support/test_data.h"
#include "tools/heel/printed_shirt.h"
#include "tools/heel/taught_shirt.h"

namespace heel {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_heel;
using test::TrueMotion;
using ::testing::AllOf;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

/// The mean distance of the region's corners from their true places.
double mean_corner_error_px(const json& found, const cv::Matx33d& truth) {
  cv::Matx33d H;
  for (int i = 0; i < 9; ++i) H.val[i] = found[static_cast<std::size_t>(i)].get<double>();
  double sum_px = 0.0;
  for (const cv::Vec3d& corner :
       {cv::Vec3d(240, 140, 1), cv::Vec3d(400, 140, 1), cv::Vec3d(400, 340, 1), cv::Vec3d(240, 340, 1)}) {
    const cv::Vec3d a = H * corner;
    const cv::Vec3d b = truth * corner;
    sum_px += std::hypot(a[0] / a[2] - b[0] / b[2], a[1] / a[2] - b[1] / b[2]);
  }
  return sum_px / 4;
}

using Pose = test::TaughtShirt;

TEST_F(Pose, AVideoThatIsCutShortIsUsedAndSaid) {
  HEEL_NEEDS_TEST_DATA("reports");
  const std::string reports = test::data_path("reports/"), video = reports + "video-cut-short/cuttail.mkv";
  const Outcome outcome = run_heel({"pose", video, "--template", reports + "common/shirt.heel",
                                    "--camera-info", reports + "common/camera.yaml", "--json"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(lines_of(outcome.out).size(), 20u);
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("found in 20 of 20"),
                    ::testing::EndsWith("heel pose: " + video + ": ends after 20 of 40 frames\n")));
}

TEST_F(Pose, TheInputAfterAVideoGoesOnInTime) {
  HEEL_NEEDS_TEST_DATA("reports");
  const std::string reports = test::data_path("reports/");
  const Outcome outcome = run_heel({"pose", reports + "video-last-frames-at-zero/walk.mp4",
                                    reports + "common/yaw20.png", "--template", reports + "common/shirt.heel",
                                    "--camera-info", reports + "common/camera.yaml", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<json> lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 41u);
  EXPECT_NEAR(lines[39]["t_s"].get<double>(), 1.95, 1e-6);
  EXPECT_NEAR(lines[40]["t_s"].get<double>(), 1.98, 0.01);
  EXPECT_NEAR(lines[40]["position_m"][0].get<double>(), 0.12, 0.02);
}

/// A camera mounted upside down: its calibration is that of the pictures as it sends them.
TEST_F(Pose, ACameraMountedUpsideDownGivesThePosesOfAnUprightOne) {
  HEEL_NEEDS_TEST_DATA("reports");
  const std::string mounted = test::data_path("reports/camera-upside-down/");
  const Outcome taught = run_heel({"teach", "--image", mounted + "ref_upside.png", "--roi", test::kRoi,
                                   "--distance", "1.5", "--reach-time", "0", "--camera-info",
                                   mounted + "cam_upside.yaml", "--rotate", "180", "-o", shirt});
  ASSERT_EQ(taught.status, 0) << taught.err;
  const Outcome outcome = run_heel({"pose", mounted + "ref_upside.png", "--template", shirt, "--camera-info",
                                    mounted + "cam_upside.yaml", "--rotate", "180", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json found = lines_of(outcome.out).at(0);
  ASSERT_TRUE(found["found"].get<bool>());
  // The middle of the region is 2.5 pixels to the left of the turned principal point.
  EXPECT_NEAR(found["position_m"][0].get<double>(), -0.0075, 0.003);
  EXPECT_NEAR(found["position_m"][2].get<double>(), 1.5, 0.02);
}

/// It was taught before the camera was mounted upside down, or after that and not turned: a template says
/// which only if teach was told.
TEST_F(Pose, ATemplateOfACameraThatWasTurnedSinceIsFound) {
  const std::string turned = folder.file("upside_down.png");
  cv::Mat upside_down;
  cv::rotate(reference, upside_down, cv::ROTATE_180);
  cv::imwrite(turned, upside_down);
  struct Taught {
    std::string image;
    std::vector<std::string> more;
    bool found;
  };
  for (const Taught& one :
       {Taught{image, {}, true}, Taught{turned, {}, true}, Taught{image, {"--rotate", "0"}, true},
        Taught{turned, {"--rotate", "180"}, true}, Taught{turned, {"--rotate", "0"}, false}}) {
    SCOPED_TRACE(one.image + (one.more.empty() ? "" : one.more.back()));
    std::vector<std::string> more{"--image", one.image};
    more.insert(more.end(), one.more.begin(), one.more.end());
    ASSERT_EQ(teach(more).status, 0);
    const json found = lines_of(pose({turned, "--rotate", "180", "--json"}).out).at(0);
    EXPECT_EQ(found["found"].get<bool>(), one.found);
    EXPECT_FALSE(found.contains("template")) << "one file";
  }
}

TEST_F(Pose, PoseFindsTheTruthAndGivesNoPoseForWhatItDoesNotFind) {
  ASSERT_EQ(teach().status, 0);
  const double rad = CV_PI / 180.0;
  // More than ten frames, so that the order of the names is not the order of the numbers.
  const std::vector<TrueMotion> motions = {
      {0, {0, 0, 0}},
      {20 * rad, {0, 0, 0.1}},
      {-20 * rad, {0.05, 0, 0.1}},
      {35 * rad, {0, 0.05, 0.2}},
      {-35 * rad, {0, 0, 0}},
      {0, {0.1, -0.05, 0.5}},
      {10 * rad, {0, 0, 0.3}},
      {-10 * rad, {-0.1, 0, 0.3}},
      {0, {0, 0, -0.2}},
      {45 * rad, {0.1, 0.0, -0.1}},
      {-45 * rad, {0, 0, 0}},
  };
  const std::filesystem::path frames = folder.path() / "frames";
  std::filesystem::create_directory(frames);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    cv::imwrite((frames / ("view" + std::to_string(i) + ".png")).string(), motions[i].picture(reference));
  }
  cv::imwrite((frames / "view99.png").string(),
              cv::Mat(test::kHeight_px, test::kWidth_px, CV_8UC1, cv::Scalar(120)));

  // The print is on a wall: the configuration says so, and the options replace what it says of files.
  const std::string config = test::write_text(folder.file("heel.toml"), "[vision]\nback_curvature_1_m = 0\n");
  const Outcome outcome =
      pose({frames.string(), "--json", "--rate", "10", "--independent", "--config", config});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("found in 11 of 12 frames"));
  const std::vector<json> lines = lines_of(outcome.out);
  ASSERT_EQ(lines.size(), 12u);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const json& line = lines[i];
    SCOPED_TRACE(line.dump());
    ASSERT_TRUE(line["found"].get<bool>());
    EXPECT_EQ(line["frame"], i);
    EXPECT_NEAR(line["t_s"].get<double>(), 0.1 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(line["reason"], "found");
    EXPECT_GT(line["certainty"].get<double>(), 0.1);
    EXPECT_GE(line["inliers"].get<int>(), 8);
    EXPECT_NEAR(line["yaw_rad"].get<double>(), motions[i].yaw_rad, 2.0 * rad);
    EXPECT_GE(line["yaw_sigma_rad"].get<double>(), 0.0);
    EXPECT_LT(line["yaw_sigma_rad"].get<double>(), 5.0 * rad);
    const cv::Vec3d t = motions[i].t_over_d();
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(line["t_over_d"][static_cast<std::size_t>(k)].get<double>(), t[k], 0.05) << k;
    }
    EXPECT_EQ(line["position_m"].size(), 3u);
    EXPECT_NEAR(line["position_m"][2].get<double>(), 1.5 * (1.0 + motions[i].move_over_d[2]), 0.04);
    ASSERT_EQ(line["H_cur_from_ref"].size(), 9u);
    EXPECT_LT(mean_corner_error_px(line["H_cur_from_ref"], motions[i].H()), 3.0);
    EXPECT_GT(line["ms"].get<double>(), 0.0);
  }

  const json& missed = lines.back();
  EXPECT_FALSE(missed["found"].get<bool>());
  EXPECT_EQ(missed["reason"], "too few features");
  EXPECT_EQ(missed["certainty"], 0.0);
  for (const char* key : {"yaw_rad", "yaw_sigma_rad", "frame_yaw_rad", "frame_yaw_sigma_rad", "t_over_d",
                          "position_m", "H_cur_from_ref"}) {
    EXPECT_TRUE(missed[key].is_null()) << key;
  }
}

TEST_F(Pose, EveryLineHasExactlyTheDocumentedKeysInTheirOrder) {
  ASSERT_EQ(teach().status, 0);
  const Outcome outcome = pose({image, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::vector<std::string> keys;
  const auto line = nlohmann::ordered_json::parse(outcome.out);
  for (const auto& item : line.items()) keys.push_back(item.key());
  EXPECT_THAT(keys, ElementsAreArray({"frame", "t_s", "found", "reason", "certainty", "inliers", "yaw_rad",
                                      "yaw_sigma_rad", "frame_yaw_rad", "frame_yaw_sigma_rad", "t_over_d",
                                      "position_m", "H_cur_from_ref", "ms"}));
}

TEST_F(Pose, PosesOfSeveralTemplatesNameTheirOwn) {
  ASSERT_EQ(teach().status, 0);
  const std::string side = folder.file("side.heel"), side_image = folder.file("side.png");
  cv::Mat print = reference.clone();  // another print of the same size
  cv::flip(reference, print, 0);
  cv::imwrite(side_image, print);
  const Outcome taught = run_heel({"teach", "--image", side_image, "--roi", test::kRoi, "--distance", "1.5",
                                   "--yaw", "-90", "--camera-info", camera, "-o", side});
  ASSERT_EQ(taught.status, 0) << taught.err;
  EXPECT_NEAR(read_template(side).yaw_rad, -CV_PI / 2.0, 1e-9);

  const std::vector<json> lines =
      lines_of(pose({"--template", side, image, side_image, "--independent", "--json"}).out);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0]["template"], shirt);
  EXPECT_NEAR(lines[0]["yaw_rad"].get<double>(), 0.0, 0.02);
  EXPECT_EQ(lines[1]["template"], side);
  EXPECT_NEAR(lines[1]["yaw_rad"].get<double>(), -CV_PI / 2.0, 0.02);
}

TEST_F(Pose, RepeatsToTheBitExceptForTimes) {
  ASSERT_EQ(teach().status, 0);
  cv::imwrite(image, TrueMotion{0.3, {0.05, 0, 0.2}}.picture(reference));
  std::vector<json> first = lines_of(pose({image, "--json"}).out);
  std::vector<json> second = lines_of(pose({image, "--json"}).out);
  ASSERT_EQ(first.size(), 1u);
  ASSERT_TRUE(first[0]["found"].get<bool>());
  first[0].erase("ms");
  second[0].erase("ms");
  EXPECT_EQ(first, second);
}

TEST_F(Pose, UsesOnlyTheRequestedFramesAndDrawsThem) {
  ASSERT_EQ(teach().status, 0);
  const std::string pictures = folder.file("pictures/of/this");
  const Outcome outcome =
      pose({image, image, image, image, "--first", "1", "--last", "2", "--picture-dir", pictures});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("found in 2 of 2 frames (100.0 %)"));
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("yaw_deg"), HasSubstr("\n      1 "), HasSubstr("\n      2 ")));
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(pictures))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("frame_000001.png", "frame_000002.png"));
  EXPECT_EQ(cv::imread(pictures + "/frame_000001.png").cols, test::kWidth_px);
}

}  // namespace
}  // namespace heel
