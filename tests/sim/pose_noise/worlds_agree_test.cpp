// Both worlds on shared scenarios: the one that draws pictures and the one that draws poses from the error
// model that is shipped give the same following figures, and truth alone is the pictured world's truth to the
// bit.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "evaluation/experiments/run_record.h"
#include "evaluation/metrics/metrics.h"
#include "heel/error.h"
#include "sim/lockstep/lockstep.h"
#include "sim/lockstep/transcript.h"
#include "sim/scene/world.h"
#include "support/sanitized.h"
#include "support/test_data.h"

namespace heel::sim {
namespace {

const std::string kModel = test::source_path("tools/heel-sim/pose_noise/pictured.toml");

LockstepSettings settings_for(const char* text, double duration_s) {
  LockstepSettings settings;
  settings.scenario = parse_scenario(text, "shared.toml");
  settings.scenario.duration_s = duration_s;
  apply_scenario(settings.scenario, settings.config);
  settings.shirt.distance_m = 1.5;
  return settings;
}

constexpr const char* kStraight = R"(
seed = 5
[person]
walk_after_s = 0.5
[[person.path]]
step = "straight"
length_m = 12.0
[robot]
x_m = -1.9
y_m = 0.4
heading_deg = -15.0
[room]
objects = 15
)";

constexpr const char* kBends = R"(
seed = 6
[person]
walk_after_s = 0.5
[[person.path]]
step = "straight"
length_m = 2.0
[[person.path]]
step = "arc"
radius_m = 2.5
angle_deg = 100.0
[[person.path]]
step = "arc"
radius_m = 2.5
angle_deg = -60.0
[robot]
x_m = -1.8
[room]
objects = 15
)";

struct Shared {
  const char* name;
  const char* text;
  double duration_s;
};
void PrintTo(const Shared& shared, std::ostream* out) {
  *out << shared.duration_s << " s";
}

evaluation::FollowMetrics run(const LockstepSettings& settings) {
  evaluation::RunRecord record("", settings);
  run_lockstep(settings, record);
  return record.metrics().evaluate();
}

/// The mean over seeds of the world without pictures.
struct Averages {
  double rms_m = 0.0, separation_m = 0.0, path_m = 0.0, found = 0.0, yaw_deviation_rad = 0.0;
};

Averages without_pictures(LockstepSettings settings, int seeds) {
  settings.errors = sim::read_error_model(kModel);
  Averages mean;
  for (int i = 0; i < seeds; ++i) {
    settings.scenario.seed = static_cast<std::uint64_t>(100 + i);
    const evaluation::FollowMetrics m = run(settings);
    mean.rms_m += m.lateral_m.rms / seeds;
    mean.separation_m += m.separation_m.mean / seeds;
    mean.path_m += m.robot_path_m / seeds;
    mean.found += static_cast<double>(m.frames_found) / static_cast<double>(m.frames) / seeds;
    mean.yaw_deviation_rad += m.yaw_error_rad.deviation / seeds;
  }
  return mean;
}

class BothWorlds : public ::testing::TestWithParam<Shared> {};

TEST_P(BothWorlds, GiveTheSameFollowingFigures) {
  if (test::kSanitized) GTEST_SKIP() << "the same code runs in Lockstep and PosesWithoutPictures";
  LockstepSettings settings = settings_for(GetParam().text, GetParam().duration_s);
  const Averages fast = without_pictures(settings, 20);
  settings.shirt = teach_from_world(settings.scenario, 1.5);
  const evaluation::FollowMetrics pictured = run(settings);
  const double found = static_cast<double>(pictured.frames_found) / static_cast<double>(pictured.frames);
  std::cout << GetParam().name << ": pictured " << pictured.lateral_m.rms << " m RMS, "
            << pictured.separation_m.mean << " m behind, " << pictured.robot_path_m << " m driven, found "
            << found << ", yaw deviation " << pictured.yaw_error_rad.deviation << " rad; without pictures "
            << fast.rms_m << ", " << fast.separation_m << ", " << fast.path_m << ", " << fast.found << ", "
            << fast.yaw_deviation_rad << "\n";
  EXPECT_NEAR(fast.rms_m, pictured.lateral_m.rms, 0.01);
  EXPECT_NEAR(fast.separation_m, pictured.separation_m.mean, 0.05);
  EXPECT_NEAR(fast.path_m, pictured.robot_path_m, 0.03 * pictured.robot_path_m);
  EXPECT_NEAR(fast.found, found, 0.03);
  // Both are about a degree; the model, fitted to other worlds, errs by less than a factor of 1.7.
  EXPECT_LT(std::abs(std::log(fast.yaw_deviation_rad / pictured.yaw_error_rad.deviation)), std::log(1.7));
}

INSTANTIATE_TEST_SUITE_P(OnSharedScenarios, BothWorlds,
                         ::testing::Values(Shared{"straight", kStraight, 14.0},
                                           Shared{"bends", kBends, 18.0}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(TruthWithoutPictures, IsThePicturedWorldsToTheBit) {
  Scenario scenario = settings_for(kBends, 10.0).scenario;
  World pictured(scenario), bare(scenario, 1, WorldUse::TruthOnly);
  pictured.start_walk(1.0);
  bare.start_walk(1.0);
  for (double t_s = 0.0; t_s < 10.0; t_s += 0.37) {
    const RobotMotion robot{-1.8 + 0.3 * t_s, 0.05 * t_s, 0.04 * t_s, 0.3, 0.1};
    const Truth a = pictured.truth(robot, t_s), b = bare.truth(robot, t_s);
    EXPECT_EQ(a.yaw_rad, b.yaw_rad);
    EXPECT_EQ(a.back_in_camera_m, b.back_in_camera_m);
    EXPECT_EQ(a.back_px, b.back_px);
    EXPECT_EQ(a.in_view, b.in_view);
  }
}

TEST(PosesWithoutPictures, RepeatToTheBitAndDifferBySeed) {
  LockstepSettings settings = settings_for(kBends, 6.0);
  settings.errors = sim::read_error_model(kModel);
  int poses_found = 0;
  const test::Transcript first = test::transcript_of(settings, &poses_found);
  EXPECT_GT(poses_found, 100);
  EXPECT_THAT(test::differences(first, test::transcript_of(settings)), testing::IsEmpty());
  settings.scenario.seed = 7;
  EXPECT_THAT(test::differences(first, test::transcript_of(settings)),
              testing::IsSupersetOf(
                  {"poses", "ticks", "truth", "bytes to the robot", "run.mcap", "truth.csv", "wire.hex"}));
}

TEST(PosesWithoutPictures, NeedTheSimulatedWorld) {
  LockstepSettings settings = settings_for(kBends, 1.0);
  settings.errors = sim::read_error_model(kModel);
  settings.scenario.camera.source = "file:walk.mp4";
  evaluation::RunRecord record("", settings);
  EXPECT_THROW(run_lockstep(settings, record), Error);
}

}  // namespace
}  // namespace heel::sim
