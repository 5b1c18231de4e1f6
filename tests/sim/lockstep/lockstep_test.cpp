// Lock step: the daemon's stages follow the simulated person, and a run repeats to the bit.
#include "sim/lockstep/lockstep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "control/control_stage.h"
#include "core/picture_turn.h"
#include "evaluation/experiments/run_record.h"
#include "evaluation/metrics/metrics.h"
#include "heel/error.h"
#include "models/robot_models.h"
#include "sim/lockstep/transcript.h"
#include "support/decisions.h"
#include "support/sanitized.h"

namespace heel::sim {
namespace {

/// Under a sanitizer a picture takes twenty times as long.
constexpr const char* kSmallPicture =
    "[camera]\nwidth_px = 320\nheight_px = 240\nfocal_px = [415.0, 415.0]\ncentre_px = [161.0, 118.0]\n";

LockstepSettings short_walk() {
  LockstepSettings settings;
  settings.scenario = parse_scenario(R"(
seed = 3
duration_s = 8.0
[person]
walk_after_s = 1.0
[[person.path]]
step = "straight"
length_m = 3.0
[robot]
x_m = -1.8
[room]
objects = 15
)" + std::string(test::kSanitized ? kSmallPicture : ""),
                                     "short.toml");
  apply_scenario(settings.scenario, settings.config);
  settings.shirt = teach_from_world(settings.scenario, 1.5);
  return settings;
}

/// The short walk with everything that could make a run depend on more than its seed.
LockstepSettings troubled_walk() {
  LockstepSettings settings = short_walk();
  Scenario& scenario = settings.scenario;
  scenario.passers_by.emplace_back();
  scenario.passers_by[0].start = {.x_m = 1.0, .y_m = 1.5, .heading_rad = -1.57};
  scenario.passers_by[0].path = {WalkItem{.length_m = 3.0}};
  scenario.obstacles.emplace_back();
  scenario.obstacles[0].y_m = -1.0;
  scenario.camera.readout_ms = 20.0;
  scenario.camera.jpeg_quality = 70;
  scenario.camera.sensor.glare = 0.1;
  scenario.camera.exposure.automatic = true;
  scenario.camera.timing = {.drop_share = 0.1, .late_share = 0.2, .late_ms = 90.0, .jitter_ms = 2.0};
  scenario.light.changes = {{1.5, 0.3}};
  scenario.room.bump_m = 0.002;
  return settings;
}

struct HowItWent : LockstepObserver {
  double moved_m = 0.0, turned_rad = 0.0;
  bool turned_away = false;
  TimeNs t_turning_ns = 0;  ///< when the robot first turned faster than 0.2 rad/s
  TimeNs t_noticed_ns = 0;
  void on_tick(const TickRecord& tick, const LockstepTruth& truth) override {
    moved_m = std::hypot(truth.robot.pose.x_m + 1.8, truth.robot.pose.y_m - 0.6);
    turned_rad = std::max(turned_rad, std::abs(truth.robot.pose.heading_rad));
    if (t_turning_ns == 0 && std::abs(truth.robot.yaw_rate_rad_s) > 0.2) t_turning_ns = truth.t_ns;
    if (t_noticed_ns == 0 && tick.stop_reason == StopReason::TurnsAway) t_noticed_ns = truth.t_ns;
    turned_away = t_noticed_ns != 0;
  }
};

/// The person is to the right of the middle of an upright picture.
HowItWent with_a_turned_camera(const PictureTurn& mounted, int rotate, bool mirror) {
  LockstepSettings settings = short_walk();
  settings.scenario.duration_s = 4.5;
  settings.scenario.robot.y_m = 0.6;
  settings.scenario.camera.turn = mounted;
  settings.config.camera.rotate = rotate;
  settings.config.camera.mirror = mirror;
  apply_scenario(settings.scenario, settings.config);
  settings.shirt = teach_from_world(settings.scenario, 1.5);
  HowItWent run;
  run_lockstep(settings, run);
  return run;
}

TEST(Lockstep, FollowsByATurnedCameraThatTheConfigurationKnows) {
  if (test::kSanitized) GTEST_SKIP() << "PictureTurn, TurnedTemplate and TurnedSource run the same code";
  const HowItWent upside_down = with_a_turned_camera(picture_turn(180, false), 180, false);
  EXPECT_FALSE(upside_down.turned_away);
  EXPECT_GT(upside_down.moved_m, 0.3);
  const HowItWent portrait = with_a_turned_camera(picture_turn(90, true), 90, true);
  EXPECT_FALSE(portrait.turned_away);
  EXPECT_GT(portrait.moved_m, 0.3);
}

TEST(Lockstep, ATurnedCameraThatTheConfigurationDoesNotKnowStopsTheRobot) {
  if (test::kSanitized)
    GTEST_SKIP() << "the person leaves the small picture before; TurnMonitor.StopsWithin… runs the same code";
  struct Wrong {
    const char* what;
    PictureTurn mounted;
    bool mirror;
  };
  for (const Wrong& wrong : {Wrong{"upside down", picture_turn(180, false), false},
                             Wrong{"mirrored", picture_turn(0, true), false},
                             Wrong{"mirrored by the configuration", picture_turn(0, false), true}}) {
    SCOPED_TRACE(wrong.what);
    const HowItWent run = with_a_turned_camera(wrong.mounted, 0, wrong.mirror);
    EXPECT_TRUE(run.turned_away);
    ASSERT_GT(run.t_turning_ns, 0);
    EXPECT_LE(seconds_from_ns(run.t_noticed_ns - run.t_turning_ns), 0.5);
    EXPECT_LT(run.turned_rad, 0.45) << "the robot needs 0.2 s and 0.1 rad to stop turning";
  }
}

TEST(Lockstep, RepeatsToTheBitAndDiffersBySeed) {
  LockstepSettings settings = troubled_walk();
  settings.scenario.duration_s = test::kSanitized ? 1.0 : 2.5;
  int poses_found = 0;
  const test::Transcript first = test::transcript_of(settings, &poses_found);
  EXPECT_THAT(test::differences(first, test::transcript_of(settings)), testing::IsEmpty());
  settings.scenario.seed = 4;
  const std::vector<std::string> by_seed = test::differences(first, test::transcript_of(settings));
  EXPECT_THAT(by_seed, testing::IsSupersetOf({"frames", "poses"}));
  if (!test::kSanitized) {  // in one second the robot does not move yet
    EXPECT_THAT(by_seed, testing::IsSupersetOf(
                             {"ticks", "truth", "bytes to the robot", "run.mcap", "truth.csv", "wire.hex"}));
  }

  // It is a run in which something happens.
  EXPECT_GT(poses_found, 0);
  for (const char* name : {"ticks", "poses", "truth", "frames", "bytes to the robot", "run.mcap", "truth.csv",
                           "wire.hex", "shirt.heel"}) {
    ASSERT_TRUE(first.contains(name)) << name;
    EXPECT_GT(first.at(name).size(), 200u) << name;
  }
}

class Records : public LockstepObserver {
 public:
  void on_tick(const TickRecord& tick, const LockstepTruth& /*truth*/) override { ticks.push_back(tick); }
  std::vector<TickRecord> ticks;
};

TEST(Lockstep, TheRecordedInputsGiveTheRecordedDecisionsAgain) {
  LockstepSettings settings = troubled_walk();
  settings.scenario.duration_s = test::kSanitized ? 3.0 : 5.0;
  for (const char* fault : {"garble@1.2+1=0.02", "bumper@1.6+0.3=4"})
    settings.scenario.robot.faults.emplace_back(fault);
  settings.config.supervisor.bumper_hold_s = 0.2;
  settings.config.supervisor.start = "at_once";
  Records run;
  run_lockstep(settings, run);

  ControlStage again(settings.config, robot_models());
  test::DecisionCounts counts;
  for (const TickRecord& record : run.ticks) {
    ASSERT_EQ(test::decision_bytes(again.tick(record.input)), test::decision_bytes(record)) << record.tick;
    counts.add(record);
  }
  // What decides is there: the lines above would hold in an empty run, too.
  EXPECT_GT(counts.moving, 20);
  EXPECT_GT(counts.accepted, 20);
  EXPECT_GT(counts.obstacle_in_the_way, 0);
  EXPECT_GT(counts.sonar_readings, 20);
  EXPECT_GT(counts.stop_reasons(), 3U);
  EXPECT_GT(run.ticks.back().input.robot.checksum_errors, 0U);
  EXPECT_EQ(run.ticks.back().stop_reason, StopReason::Shutdown);
}

/// The short walk with the operator's actions.
LockstepSettings operated_walk(double duration_s, std::vector<OperatorAction> actions) {
  LockstepSettings settings = short_walk();
  settings.scenario.duration_s = duration_s;
  settings.operator_actions = std::move(actions);
  return settings;
}

TEST(Lockstep, NothingMovesBeforeTheOperatorStarts) {
  if (test::kSanitized) GTEST_SKIP() << "the same threads as above, for a longer time";
  Records run;
  run_lockstep(operated_walk(5.0, {{2.5, OperatorCommand::Start}, {4.0, OperatorCommand::EStop}}), run);
  int moving = 0;
  for (const TickRecord& tick : run.ticks) {
    const double t_s = seconds_from_ns(tick.input.now_ns);
    const bool allowed = t_s >= 2.5 && t_s < 4.0;
    ASSERT_TRUE(allowed || tick.command.v_m_s == 0.0) << t_s;
    moving += tick.command.v_m_s > 0.1;
  }
  EXPECT_GT(moving, 25);
  EXPECT_EQ(run.ticks.back().state, SupervisorState::Emergency);
}

TEST(Lockstep, AfterTheStopButtonAResetEnablesTheMotorsAgain) {
  if (test::kSanitized) GTEST_SKIP() << "the same threads as above, for a longer time";
  LockstepSettings settings = operated_walk(6.0, {{1.0, OperatorCommand::Start},
                                                  {3.4, OperatorCommand::Reset},
                                                  {4.0, OperatorCommand::Start},
                                                  {4.4, OperatorCommand::Reset},
                                                  {5.2, OperatorCommand::Start}});
  settings.scenario.robot.faults.emplace_back("stop_button@3+0.8");
  Records run;
  run_lockstep(settings, run);
  const auto at = [&run](double t_s) { return run.ticks.at(static_cast<std::size_t>(t_s * 50.0 + 0.5)); };
  EXPECT_GT(at(2.9).command.v_m_s, 0.1);
  for (int tick = 160; tick < 260; ++tick) ASSERT_EQ(run.ticks.at(tick).command.v_m_s, 0.0) << tick;
  EXPECT_EQ(at(3.3).state, SupervisorState::Stopped);
  EXPECT_EQ(at(3.6).refused_by, StopReason::StopButton) << "a reset while the button is pressed";
  EXPECT_EQ(at(4.2).outcome, OperatorOutcome::Refused) << "a start before the reset";
  EXPECT_EQ(at(4.2).refused_by, StopReason::MotorsOff);
  EXPECT_FALSE(at(4.3).input.robot.motors_enabled);
  EXPECT_TRUE(at(5.1).input.robot.motors_enabled);
  EXPECT_EQ(at(5.1).state, SupervisorState::Idle);
  EXPECT_NE(at(5.3).state, SupervisorState::Idle);
  EXPECT_EQ(at(5.3).outcome, OperatorOutcome::Done);
}

TEST(Lockstep, FollowsAWalkingPerson) {
  if (test::kSanitized)
    GTEST_SKIP() << "RepeatsToTheBitAndDiffersBySeed runs the same threads for a shorter time";
  const LockstepSettings settings = short_walk();
  evaluation::RunRecord record("", settings);
  const LockstepCounts counts = run_lockstep(settings, record);
  const evaluation::FollowMetrics metrics = record.metrics().evaluate();
  const double ticks = settings.config.control.rate_hz * settings.scenario.duration_s;
  EXPECT_EQ(counts.ticks, static_cast<std::uint64_t>(ticks) + 1);  // and the one that shuts down
  EXPECT_NEAR(static_cast<double>(counts.frames), 239.0, 1.0);
  EXPECT_GT(metrics.robot_path_m, 1.0);
  EXPECT_LT(metrics.out_of_view_longest_s, 0.5);
  EXPECT_LT(metrics.lateral_m.rms, 0.15);
  EXPECT_LT(std::abs(metrics.yaw_error_rad.mean), 0.05);
  EXPECT_LT(metrics.z_error_m.rms, 0.06);
  EXPECT_GT(metrics.separation_m.lowest, 1.2);
}

TEST(Lockstep, SlowVisionLosesFramesButNotThePerson) {
  if (test::kThreadSanitizer)
    GTEST_SKIP() << "RepeatsToTheBitAndDiffersBySeed runs the same threads for a shorter time";
  LockstepSettings settings = short_walk();
  settings.scenario.duration_s = 5.0;
  settings.scenario.vision_latency_ms = 80.0;  // every third frame can be looked at
  evaluation::RunRecord record("", settings);
  const LockstepCounts counts = run_lockstep(settings, record);
  EXPECT_GT(counts.frames_overtaken, counts.frames / 3);
  EXPECT_GT(record.metrics().evaluate().robot_path_m, 0.3);
}

/// Keeps what the poses' times say.
class PoseTimes : public LockstepObserver {
 public:
  void on_pose(const FrameView& frame, const PoseEstimate& pose, const LockstepTruth& truth) override {
    stamp_error_s.push_back(seconds_from_ns(frame.header.t_capture_ns - truth.t_ns));
    latency_s.push_back(seconds_from_ns(pose.t_done_ns - truth.t_ns));
  }
  std::vector<double> stamp_error_s, latency_s;
};

TEST(Lockstep, FramesAreDroppedLateAndIllStamped) {
  if (test::kThreadSanitizer)
    GTEST_SKIP() << "RepeatsToTheBitAndDiffersBySeed runs the same threads for a shorter time";
  LockstepSettings settings = short_walk();
  settings.scenario.duration_s = test::kSanitized ? 2.0 : 6.0;
  settings.scenario.camera.timing = {
      .drop_share = 0.2, .late_share = 0.2, .late_ms = 100.0, .jitter_ms = 3.0};
  PoseTimes times;
  const LockstepCounts counts = run_lockstep(settings, times);
  EXPECT_NEAR(static_cast<double>(counts.frames_dropped), 0.2 * static_cast<double>(counts.frames), 15.0);
  // What came was seen, but for what was overtaken (the last may still be waiting).
  EXPECT_NEAR(static_cast<double>(times.latency_s.size()),
              static_cast<double>(counts.frames - counts.frames_dropped - counts.frames_overtaken), 1.0);
  double worst_stamp = 0, longest = 0, shortest = 1;
  for (std::size_t i = 0; i < times.latency_s.size(); ++i) {
    worst_stamp = std::max(worst_stamp, std::abs(times.stamp_error_s[i]));
    longest = std::max(longest, times.latency_s[i]);
    shortest = std::min(shortest, times.latency_s[i]);
  }
  EXPECT_GT(worst_stamp, 0.003);
  EXPECT_LE(worst_stamp, 0.009 + 1e-9);
  EXPECT_NEAR(shortest, 0.029, 1e-6);  // half the exposure and vision's 25 ms
  EXPECT_GT(longest, 0.029 + 0.05);
}

TEST(Lockstep, PlainShirtIsRefusedWithTheReason) {
  Scenario scenario = short_walk().scenario;
  scenario.person.shirt = ShirtDesign::Plain;
  EXPECT_THROW(teach_from_world(scenario, 1.5), Error);
}

}  // namespace
}  // namespace heel::sim
