// heel teach and heel pose on a real video of real people: where the back is found, and the golden poses.
//
// The golden file says where it comes from in its first lines. It is rewritten only when asked:
//   HEEL_UPDATE_GOLDEN=1 build/release/bin/test_golden_pose
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "heel/camera_model.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_heel;

const std::string kGoldenFile = test::source_path("tests/golden/pose/knit_back.golden");
constexpr const char* kVideo = "person/one-by-one.mp4";
constexpr const char* kProvenance =
    "# Poses of the knitted back in person/one-by-one.mp4 (768x432, intel-iot-devkit/sample-videos, CC BY "
    "4.0).\n"
    "# Template: heel teach --frame 1000 --roi 400,90,100,175 --distance 3. Camera: not calibrated; taken "
    "as\n"
    "# fx = fy = 700 px, centre of the image, no distortion.\n"
    "# Made by test_golden_pose with HEEL_UPDATE_GOLDEN=1. Compared within: certainty 0.05, yaw 0.05 rad, "
    "position\n"
    "# 0.05 m, because vector instructions sum in different orders on different processors.\n"
    "# frame certainty yaw_rad x_m y_m z_m, every tenth frame\n";

constexpr int kFirst = 950;  // the back is seen from straight behind, or nearly
constexpr int kLast = 1170;
constexpr int kEntering = 925;  // before this frame and after the next the person is not seen from behind
constexpr int kTurned = 1185;

/// Runs teach and pose over the whole video, once for all tests.
class RealVideo : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!test::has_data(kVideo)) return;
    const std::string video = test::data_path(kVideo);
    const test::TemporaryFolder folder;
    const std::string camera = folder.file("camera.yaml");
    const std::string shirt = folder.file("knit.heel");
    CameraModel guess;
    guess.width_px = 768;
    guess.height_px = 432;
    guess.fx = guess.fy = 700.0;
    guess.cx = 383.5;
    guess.cy = 215.5;
    write_camera_model(guess, camera);
    const Outcome taught = run_heel({"teach", "--image", video, "--frame", "1000", "--roi", "400,90,100,175",
                                     "--distance", "3", "--camera-info", camera, "-o", shirt});
    ASSERT_EQ(taught.status, 0) << taught.out << taught.err;
    const Outcome posed = run_heel({"pose", "--template", shirt, "--camera-info", camera, video, "--json"});
    ASSERT_EQ(posed.status, 0) << posed.err;
    std::istringstream in(posed.out);
    for (std::string line; std::getline(in, line);) lines().push_back(json::parse(line));
  }
  void SetUp() override {
    HEEL_NEEDS_TEST_DATA(kVideo);
    ASSERT_FALSE(lines().empty()) << "heel teach or heel pose failed on the video";
  }
  static std::vector<json>& lines() {
    static std::vector<json> all;
    return all;
  }
};

TEST_F(RealVideo, TheBackIsFoundInNearlyEveryFrameThatShowsIt) {
  ASSERT_EQ(lines().size(), 1394u);
  int reliable = 0;
  for (int frame = kFirst; frame <= kLast; ++frame) {
    const json& line = lines()[static_cast<std::size_t>(frame)];
    ASSERT_EQ(line["frame"], frame);
    reliable += line["found"].get<bool>() && line["certainty"].get<double>() > 0.1;
  }
  EXPECT_GE(reliable, 0.95 * (kLast - kFirst + 1));
}

TEST_F(RealVideo, NothingIsFoundInTheFramesWithoutIt) {
  int looked_at = 0;
  for (const json& line : lines()) {
    const int frame = line["frame"].get<int>();
    if (frame >= kEntering && frame <= kTurned) continue;
    ++looked_at;
    EXPECT_FALSE(line["found"].get<bool>()) << line;
  }
  EXPECT_EQ(looked_at, 1133);
}

std::string golden_text(const std::vector<json>& lines) {
  std::string text = kProvenance;
  for (std::size_t frame = kFirst; frame <= kLast; frame += 10) {
    const json& line = lines[frame];
    if (!line["found"].get<bool>()) continue;
    char row[120];
    std::snprintf(row, sizeof row, "%zu %.3f %.3f %.3f %.3f %.3f\n", frame, line["certainty"].get<double>(),
                  line["yaw_rad"].get<double>(), line["position_m"][0].get<double>(),
                  line["position_m"][1].get<double>(), line["position_m"][2].get<double>());
    text += row;
  }
  return text;
}

TEST_F(RealVideo, PosesEqualTheGoldenFile) {
  if (std::getenv("HEEL_UPDATE_GOLDEN") != nullptr) {
    test::write_text(kGoldenFile, golden_text(lines()));
    GTEST_SKIP() << "wrote " << kGoldenFile;
  }
  std::ifstream golden(kGoldenFile);
  ASSERT_TRUE(golden) << kGoldenFile;
  int rows = 0;
  // A row may differ by the golden file's tolerances, which are as large as the differences between rows; the
  // mean may not.
  double certainty_off = 0, yaw_off = 0, position_off = 0;
  for (std::string text; std::getline(golden, text);) {
    if (text.starts_with('#')) continue;
    std::size_t frame = 0;
    double certainty = 0, yaw_rad = 0, x_m = 0, y_m = 0, z_m = 0;
    ASSERT_EQ(
        std::sscanf(text.c_str(), "%zu %lf %lf %lf %lf %lf", &frame, &certainty, &yaw_rad, &x_m, &y_m, &z_m),
        6);
    ASSERT_LT(frame, lines().size());
    const json& line = lines()[frame];
    SCOPED_TRACE(line.dump());
    ASSERT_TRUE(line["found"].get<bool>());
    EXPECT_NEAR(line["certainty"].get<double>(), certainty, 0.05);
    EXPECT_NEAR(line["yaw_rad"].get<double>(), yaw_rad, 0.05);
    EXPECT_NEAR(line["position_m"][0].get<double>(), x_m, 0.05);
    EXPECT_NEAR(line["position_m"][1].get<double>(), y_m, 0.05);
    EXPECT_NEAR(line["position_m"][2].get<double>(), z_m, 0.05);
    certainty_off += std::abs(line["certainty"].get<double>() - certainty);
    yaw_off += std::abs(line["yaw_rad"].get<double>() - yaw_rad);
    position_off += std::abs(line["position_m"][0].get<double>() - x_m) +
                    std::abs(line["position_m"][1].get<double>() - y_m) +
                    std::abs(line["position_m"][2].get<double>() - z_m);
    ++rows;
  }
  ASSERT_EQ(rows, 23);
  EXPECT_LT(certainty_off / rows, 0.01);
  EXPECT_LT(yaw_off / rows, 0.01);
  EXPECT_LT(position_off / rows, 0.01);
}

}  // namespace
}  // namespace heel
