// heeld with a recorded video as its camera, in real time over a pty to heel-sim, beside the lock step on the
// same frames: vision gives the same poses, to the bit, and the robot receives the same commands, within the
// delays of a busy machine. (video_lockstep_test.cpp holds the lock step to the golden file.)
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "files/csv_table.h"
#include "golden/video/frame_commands.h"
#include "golden/video/video_scene.h"
#include "support/exported.h"
#include "support/process.h"
#include "support/sanitized.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::FrameClock;
using test::FrameCommands;
using test::kGainYaw_1_s;
using test::kPatience_s;
using test::kVideo;
using test::kVideoRate_Hz;
using test::mean_by_frame;
using test::Process;
using test::read_wire;
using test::VideoScene;

// Some seconds before the back is seen, to connect to the robot.
constexpr int kFirst = 892;
constexpr int kLast = 1195;
constexpr int kCompareFirst = 925;
constexpr int kCompareLast = 1190;
constexpr double kVideo_s = (kLast - kFirst + 1) / kVideoRate_Hz;
constexpr double kLastFrame_s = 0.05;  ///< after its capture, until vision has answered it
constexpr const char* kAnswers[] = {"reason",         "tracked",          "inliers",         "matches",
                                    "frame_features", "yaw_rad",          "yaw_sigma_rad",   "position_m_0",
                                    "position_m_2",   "H_cur_from_ref_0", "H_cur_from_ref_2"};
constexpr int kShiftFrames = 3;  // ±0.3 s at 10 Hz
// A frame's mean depends on where in the frame a change falls: at 600 mm/s² a peak loses up to 30 mm/s.
constexpr double kVelTolerance_mm_s = 40.0;
constexpr double kRvelTolerance_deg_s = 4.0;

/// The smallest and the largest command of the frames near in time.
struct Envelope {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -std::numeric_limits<double>::infinity();
  void add(double value) {
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
  }
  bool holds(double value, double tolerance) const {
    return value >= lowest - tolerance && value <= highest + tolerance;
  }
};

/// The compared frames of `commands` that differ from all near frames of `others`.
std::vector<std::string> unmet(const FrameCommands& commands, const FrameCommands& others) {
  std::vector<std::string> found;
  for (const auto& [frame, velocity] : commands) {
    if (frame < kCompareFirst || frame > kCompareLast) continue;
    Envelope vel, rvel;
    const auto end = others.upper_bound(frame + kShiftFrames);
    for (auto other = others.lower_bound(frame - kShiftFrames); other != end; ++other) {
      vel.add(other->second.vel_mm_s);
      rvel.add(other->second.rvel_deg_s);
    }
    if (vel.holds(velocity.vel_mm_s, kVelTolerance_mm_s) &&
        rvel.holds(velocity.rvel_deg_s, kRvelTolerance_deg_s))
      continue;
    char text[200];
    std::snprintf(text, sizeof text,
                  "frame %d: VEL %.0f, RVEL %.0f; nearby VEL %.0f to %.0f, RVEL %.0f to %.0f", frame,
                  velocity.vel_mm_s, velocity.rvel_deg_s, vel.lowest, vel.highest, rvel.lowest, rvel.highest);
    found.emplace_back(text);
  }
  return found;
}

class VideoDrivesHeeld : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::kSanitized) {
      GTEST_SKIP() << "sanitized vision cannot keep up with the video in real time; test_golden_video runs";
    }
    HEEL_NEEDS_TEST_DATA(kVideo);
  }
};

/// Runs heeld on the cut video until the video ends; what the robot received is in wire.hex.
void drive(const VideoScene& scene) {
  const std::string config = scene.write_config(kGainYaw_1_s, "file:" + scene.cut_frames(kFirst, kLast));
  Process robot({test::built_program("heel-sim"), "--robot", "pty:" + scene.file("robot"), "--exact",
                 "--wire", scene.file("wire.hex")},
                scene.file("robot.log"));
  ASSERT_TRUE(robot.says("ready at")) << robot.output();
  Process daemon({test::built_program("heeld"), "--config", config}, scene.file("heeld.log"));
  ASSERT_EQ(daemon.wait(kVideo_s + kPatience_s), 0) << daemon.output() << robot.output();
  ASSERT_TRUE(robot.says("closed")) << daemon.output() << robot.output();
  robot.signal(SIGTERM);
  ASSERT_EQ(robot.wait(), 0) << robot.output();
}

/// The same frames in lock step, with the vision latency that heeld had: with another one, the commands
/// differ by how far the person walks in the difference.
void simulate(const VideoScene& scene, double vision_latency_s) {
  const test::Outcome ran = test::run_heel(
      {"simulate",
       scene.write_scenario("file:" + scene.file("frames"), kVideo_s + kLastFrame_s, 1e3 * vision_latency_s),
       "--config", scene.write_config(kGainYaw_1_s), "--template", scene.file("knit.heel"), "--out",
       scene.file("lockstep")});
  ASSERT_EQ(ran.status, 0) << ran.err;
  test::exported(scene.file("lockstep"));
}

/// From poses.csv: what vision answered, for each frame counted from `first_count`.
std::vector<std::string> answers(const std::string& poses_csv) {
  const CsvTable poses(poses_csv);
  std::vector<std::string> found;
  for (std::size_t row = 0; row < poses.rows(); ++row) {
    found.emplace_back();
    for (const char* column : kAnswers) found.back() += poses.text(row, column) + " ";
  }
  return found;
}

/// "frame N: …; …" for each frame with two answers, or with one only.
std::vector<std::string> differing(std::vector<std::string> these, std::vector<std::string> those) {
  const std::size_t frames = std::max(these.size(), those.size());
  these.resize(frames, "no answer");
  those.resize(frames, "no answer");
  std::vector<std::string> found;
  for (std::size_t i = 0; i < frames; ++i)
    if (these[i] != those[i])
      found.push_back("frame " + std::to_string(kFirst + static_cast<int>(i)) + ": " + these[i] + "; " +
                      those[i]);
  return found;
}

/// The latest tick of the control loop.
double latest_tick_s(const std::string& ticks_csv) {
  const CsvTable ticks(ticks_csv);
  double latest_us = 0.0;
  for (std::size_t row = 0; row < ticks.rows(); ++row)
    latest_us = std::max(latest_us, ticks.number(row, "lateness_us"));
  return 1e-6 * latest_us;
}

TEST_F(VideoDrivesHeeld, SeesAndCommandsWhatTheLockStepDoes) {
  // On a busy machine heeld stops the robot, misses frames or ticks late. Such a run does not test the
  // commands.
  constexpr double kHeldUp_s = 0.3, kLate_s = 0.1;
  constexpr int kRuns = 3;
  for (int run = 1;; ++run) {
    const VideoScene scene;
    ASSERT_NO_FATAL_FAILURE(drive(scene));
    test::exported(scene.file("run"));
    const FrameClock clock(scene.file("run/poses.csv"), kFirst, 0);
    const double late_s = latest_tick_s(scene.file("run/ticks.csv"));
    if (clock.oldest_view_s() > kHeldUp_s || clock.missing() > 0 || late_s > kLate_s) {
      std::printf("run %d was held up: a view %.2f s old, %d frames missed, a tick %.2f s late\n", run,
                  clock.oldest_view_s(), clock.missing(), late_s);
      if (run == kRuns) GTEST_SKIP() << "the machine is too busy for real time";
      continue;
    }
    ASSERT_NO_FATAL_FAILURE(simulate(scene, clock.vision_latency_s()));
    EXPECT_THAT(differing(answers(scene.file("run/poses.csv")), answers(scene.file("lockstep/poses.csv"))),
                testing::IsEmpty());

    const FrameCommands received = mean_by_frame(read_wire(scene.file("wire.hex")), clock);
    const FrameClock lockstep_clock(scene.file("lockstep/poses.csv"), kFirst, 1);
    const FrameCommands expected = mean_by_frame(read_wire(scene.file("lockstep/wire.hex")), lockstep_clock);
    ASSERT_FALSE(received.empty());
    EXPECT_LT(received.begin()->first, kCompareFirst) << "the robot was connected too late";
    EXPECT_THAT(unmet(expected, received), testing::IsEmpty()) << "commands that the robot did not receive";
    EXPECT_THAT(unmet(received, expected), testing::IsEmpty()) << "commands that are not the lock step's";
    return;
  }
}

}  // namespace
}  // namespace heel
