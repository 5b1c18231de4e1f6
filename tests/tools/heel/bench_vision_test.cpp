// heel bench vision: the form of its output. No test depends on the speed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "support/figure.h"
#include "support/sanitized.h"
#include "tools/heel/printed_shirt.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using nlohmann::ordered_json;
using test::Outcome;
using test::run_heel;
using test::TemporaryFolder;
using test::TrueMotion;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

const std::vector<std::string> kExtraction{"integral", "hessian", "selection", "description"};
const std::vector<std::string> kAllStages{"integral",    "hessian",         "selection",
                                          "description", "matching",        "undistortion",
                                          "homography",  "guided_matching", "motion"};

std::vector<std::string> keys_of(const ordered_json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

/// Checks that the times are in order and that the ratio is that of the two medians.
void expect_sound(const ordered_json& figure, const ordered_json& yardsticks) {
  const double min_ms = figure["min_ms"], median_ms = figure["median_ms"], p99_ms = figure["p99_ms"];
  EXPECT_GT(min_ms, 0.0);
  EXPECT_LE(min_ms, median_ms);
  EXPECT_LE(median_ms, p99_ms);
  const ordered_json& yardstick = yardsticks.at(figure.at("yardstick").get<std::string>());
  EXPECT_DOUBLE_EQ(figure["ratio"].get<double>(), median_ms / yardstick["median_ms"].get<double>());
}

void expect_stages(const ordered_json& figure, const std::vector<std::string>& names) {
  EXPECT_THAT(keys_of(figure["stages"]), ElementsAreArray(names));
  EXPECT_GE(figure["stage_share"].get<double>(), 0.9);
  EXPECT_LE(figure["stage_share"].get<double>(), 1.0);
}

TEST(BenchVision, TheDefaultWalkIsTrackedAndGivesEveryDocumentedFigure) {
  const TemporaryFolder folder;
  const int frames = test::kSanitized ? 2 : 24;
  const Outcome outcome = run_heel({"bench", "vision", "--json", "--frames", std::to_string(frames)});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto json = ordered_json::parse(outcome.out);

  EXPECT_THAT(keys_of(json), ElementsAre("machine", "settings", "found_share", "tracked_share", "figures",
                                         "yardsticks", "machine_scale", "cost_models"));
  EXPECT_THAT(keys_of(json["machine"]), IsSupersetOf({"cpu", "highway_target", "opencv", "load_1min"}));
  EXPECT_EQ(json["settings"]["width_px"], 640);
  EXPECT_EQ(json["settings"]["frames"], frames);
  EXPECT_EQ(json["found_share"], 1.0);
  EXPECT_GT(json["tracked_share"].get<double>(), 0.9);

  const ordered_json& figures = json["figures"];
  EXPECT_THAT(keys_of(figures), ElementsAre("search", "tracking", "features", "matcher", "homography",
                                            "decomposition", "search_1080p"));
  EXPECT_THAT(keys_of(json["yardsticks"]),
              ElementsAre("bf_matcher", "usac_magsac", "decompose_homography_mat", "orb_1000", "akaze",
                          "sift", "orb_3000"));
  for (const auto& [name, figure] : figures.items()) {
    SCOPED_TRACE(name);
    expect_sound(figure, json["yardsticks"]);
    const ordered_json& goal = figure["goal"];
    if (name == "decomposition") {
      EXPECT_TRUE(goal.is_null() && figure["reached"].is_null());
    } else {
      EXPECT_EQ(figure["reached"].get<bool>(), figure["ratio"].get<double>() <= goal.get<double>());
    }
    // A frame in which the small shirt is not found does not go through all stages: their times may be 0.
    if (name == "search_1080p") continue;
    for (const auto& stage : figure.value("stages", ordered_json::object()))
      expect_sound(stage, json["yardsticks"]);
  }
  expect_stages(figures["search"], kAllStages);
  expect_stages(figures["tracking"], kAllStages);
  expect_stages(figures["features"], kExtraction);
  EXPECT_EQ(figures["search_1080p"]["yardstick"], "orb_3000");
  EXPECT_EQ(figures["search_1080p"]["frames"], std::min(frames, 12));
  EXPECT_GE(figures["search_1080p"]["found_share"].get<double>(), 0.0);
  EXPECT_EQ(json["yardsticks"]["orb_3000"]["features"], 3000.0) << "a cluttered room";
  EXPECT_LE(figures["homography"]["corner_error_px"].get<double>(), 3.0);
  EXPECT_THAT(keys_of(json["cost_models"]), ElementsAre("integral", "hessian", "description", "matcher"));
}

TEST(BenchVision, AnotherSizeHasNoGoalsAndCanBeDrawn) {
  const TemporaryFolder folder;
  const std::string picture = folder.file("bench.png");
  const Outcome outcome =
      run_heel({"bench", "vision", "--json", "--frames", "1", "--size", "400x300", "--picture", picture});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = ordered_json::parse(outcome.out);
  EXPECT_EQ(json["settings"]["width_px"], 400);
  EXPECT_EQ(json["settings"]["height_px"], 300);
  EXPECT_TRUE(json["figures"]["search"]["goal"].is_null());
  EXPECT_FALSE(json["figures"].contains("search_1080p"));
  EXPECT_TRUE(json["cost_models"].empty());
  test::expect_figure(folder.file("bench"), {1320, 900});
  EXPECT_EQ(ordered_json::parse(test::read_text(folder.file("bench.json"))), json);
}

TEST(BenchVision, MeasuresGivenPictures) {
  const TemporaryFolder folder;
  const std::string camera = folder.file("camera.yaml"), shirt = folder.file("shirt.heel");
  const std::string back = folder.file("back.png");
  write_camera_model(test::shirt_camera(), camera);
  const cv::Mat reference = test::printed_plane();
  cv::imwrite(back, reference);
  ASSERT_EQ(run_heel({"teach", "--image", back, "--roi", test::kRoi, "--distance", "1.5", "--camera-info",
                      camera, "-o", shirt})
                .status,
            0);
  const std::filesystem::path frames = folder.path() / "frames";
  std::filesystem::create_directory(frames);
  for (int i = 0; i < 3; ++i)
    cv::imwrite((frames / ("view" + std::to_string(i) + ".png")).string(),
                TrueMotion{0.05 * i, {0.01 * i, 0, 0.2}}.picture(reference));
  const Outcome outcome =
      run_heel({"bench", "vision", "--template", shirt, "--camera-info", camera, frames.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("2 frames of 640 x 480, " + frames.string()),
                                 HasSubstr("found in 100 %, tracked in 100 %"), HasSubstr("cv::SIFT"),
                                 HasSubstr("fast-Hessian"), HasSubstr("<= 0.4")));
}

}  // namespace
}  // namespace heel
