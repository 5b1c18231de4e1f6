// A real video of real people through the stages in lock step: the commands on the wire equal the golden
// file.
//
// The golden file says where it comes from in its first lines. It is rewritten only when asked:
//   HEEL_UPDATE_GOLDEN=1 build/release/bin/test_golden_video
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "golden/video/frame_commands.h"
#include "golden/video/video_scene.h"
#include "support/exported.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::crc32_of_file;
using test::data_path;
using test::FrameClock;
using test::FrameCommands;
using test::golden_text;
using test::kGainYaw_1_s;
using test::kGoldenFile;
using test::kVideo;
using test::kVideoCrc32;
using test::kVideoFrames;
using test::read_golden;
using test::read_wire;
using test::Velocity;
using test::VideoScene;

// Before and after these frames the person is not seen from behind, and the robot has had time to stop.
constexpr int kBackSeenFirst = 925;
constexpr int kBackSeenLast = 1192;
constexpr double kVelTolerance_mm_s = 10.0;
constexpr double kRvelTolerance_deg_s = 0.8;

constexpr const char* kProvenance =
    "# Velocity commands on the wire while person/one-by-one.mp4 is seen (768x432, 10 Hz, 1394 frames,\n"
    "# CRC-32 %08x; intel-iot-devkit/sample-videos, CC BY 4.0).\n"
    "# Template: heel teach --frame 1000 --roi 400,90,100,175 --distance 3. Camera: not calibrated; taken "
    "as\n"
    "# fx = fy = 700 px, centre of the image, no distortion. Then heel simulate --config, with the gains "
    "and\n"
    "# limits of tests/golden/video/video_scene.cpp, and wire.hex decoded. The video does not see the robot\n"
    "# move, so the commands are right for what is seen and do not arrive anywhere.\n"
    "# Made by test_golden_video with HEEL_UPDATE_GOLDEN=1. Compared within 10 mm/s and 0.8 deg/s, because\n"
    "# vector instructions sum in different orders on different processors.\n"
    "# frame VEL_mm_s RVEL_deg_s: means from one frame to the next, change points only\n";

std::string provenance() {
  char text[1200];
  std::snprintf(text, sizeof text, kProvenance, kVideoCrc32);
  return text;
}

std::vector<std::string> differences(const FrameCommands& golden, const FrameCommands& commands) {
  std::vector<std::string> found;
  for (const auto& [frame, expected] : golden) {
    const auto one = commands.find(frame);
    if (one == commands.end()) {
      found.push_back("frame " + std::to_string(frame) + ": no command");
      continue;
    }
    const Velocity& sent = one->second;
    // The golden file has whole units.
    if (std::abs(sent.vel_mm_s - expected.vel_mm_s) <= kVelTolerance_mm_s + 0.5 &&
        std::abs(sent.rvel_deg_s - expected.rvel_deg_s) <= kRvelTolerance_deg_s + 0.5)
      continue;
    char text[160];
    std::snprintf(text, sizeof text, "frame %d: VEL %.1f, RVEL %.1f; expected %.0f and %.0f", frame,
                  sent.vel_mm_s, sent.rvel_deg_s, expected.vel_mm_s, expected.rvel_deg_s);
    found.emplace_back(text);
  }
  return found;
}

class VideoOnTheWire : public ::testing::Test {
 protected:
  void SetUp() override {
    HEEL_NEEDS_TEST_DATA(kVideo);
    ASSERT_EQ(crc32_of_file(data_path(kVideo)), kVideoCrc32) << "the golden file was made from another video";
    scene_.emplace();
  }

  /// Runs once for each gain; several tests use the result.
  const FrameCommands& simulate(double gain_yaw_1_s) const {
    static std::map<double, FrameCommands> known;
    const auto [entry, is_new] = known.try_emplace(gain_yaw_1_s);
    if (is_new) entry->second = run(gain_yaw_1_s);
    return entry->second;
  }

 private:
  FrameCommands run(double gain_yaw_1_s) const {
    const test::Outcome ran =
        test::run_heel({"simulate", scene_->write_scenario(), "--config", scene_->write_config(gain_yaw_1_s),
                        "--template", scene_->file("knit.heel"), "--out", scene_->file("run")});
    if (ran.status != 0) throw std::runtime_error("heel simulate: " + ran.err);
    // Lock step counts frames from 1.
    const FrameClock clock(test::exported(scene_->file("run")) + "/poses.csv", 0, 1);
    EXPECT_EQ(clock.frames(), static_cast<std::size_t>(kVideoFrames));
    return mean_by_frame(read_wire(scene_->file("run/wire.hex")), clock);
  }

  std::optional<VideoScene> scene_;
};

TEST_F(VideoOnTheWire, CommandsEqualTheGoldenFile) {
  const FrameCommands commands = simulate(kGainYaw_1_s);
  if (std::getenv("HEEL_UPDATE_GOLDEN") != nullptr) {
    test::write_text(kGoldenFile, golden_text(provenance(), commands));
    GTEST_SKIP() << "wrote " << kGoldenFile;
  }
  const FrameCommands golden = read_golden(kGoldenFile);
  EXPECT_GT(golden.size(), 1380u) << "the golden file covers the whole video";
  EXPECT_THAT(differences(golden, commands), testing::IsEmpty());
}

TEST_F(VideoOnTheWire, RestsWhileTheBackIsNotSeen) {
  int frames = 0;
  for (const auto& [frame, velocity] : simulate(kGainYaw_1_s)) {
    if (frame >= kBackSeenFirst && frame <= kBackSeenLast) continue;
    ++frames;
    EXPECT_EQ(velocity.vel_mm_s, 0.0) << frame;
    EXPECT_EQ(velocity.rvel_deg_s, 0.0) << frame;
  }
  EXPECT_GT(frames, 1000);
}

TEST_F(VideoOnTheWire, AGainThatIsTenPercentWrongChangesTheCommands) {
  const auto found = differences(read_golden(kGoldenFile), simulate(1.1 * kGainYaw_1_s));
  EXPECT_GT(found.size(), 25u);
}

}  // namespace
}  // namespace heel
