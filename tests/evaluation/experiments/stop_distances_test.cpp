// Stop distances: what physics must give, from the operator's command to the wheels.
#include "evaluation/experiments/stop_distances.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/test_data.h"

namespace heel::evaluation {
namespace {

const sim::ErrorModel& errors_of_the_pictured_world() {
  static const sim::ErrorModel errors =
      sim::read_error_model(test::source_path("tools/heel-sim/pose_noise/pictured.toml"));
  return errors;
}

StopDistance stop_by(StopTrigger trigger, const Config& config = {}) {
  return measure_stop(trigger, 0.5, config, errors_of_the_pictured_world(), 1);
}

TEST(StopDistances, GrowFromTheEmergencyStopToTheCutLine) {
  const StopDistance estop = stop_by(StopTrigger::EStop);
  const StopDistance silent = stop_by(StopTrigger::RobotSilent);
  const StopDistance cut = stop_by(StopTrigger::LineCut);
  for (const StopDistance& stop : {estop, silent, cut}) EXPECT_NEAR(stop.v_m_s, 0.5, 0.06);
  // Braking alone: v² / 2a = 0.083 m in v / a = 0.33 s; a tick, the line and the controller's cycle come
  // before.
  EXPECT_GT(estop.distance_m, 0.08);
  EXPECT_LT(estop.distance_m, 0.15);
  EXPECT_LT(estop.rest_s, 0.6);
  // The last packet is supervisor.sip_timeout_s old, 0.5 s, when heeld stops the robot.
  EXPECT_NEAR(silent.rest_s - estop.rest_s, 0.5, 0.15);
  // The robot's watchdog waits 2 s after the last command.
  EXPECT_NEAR(cut.rest_s - estop.rest_s, 2.0, 0.15);
  EXPECT_NEAR(cut.distance_m - estop.distance_m, 2.0 * 0.5, 0.15);
}

TEST(StopDistances, OfAStopAreWithinWhatTheGateKeepsFree) {
  const StopDistance stop = stop_by(StopTrigger::Stop);
  EXPECT_LT(stop.distance_m, 0.5 * 0.5 / Config{}.gate.deceleration_m_s2);
}

TEST(StopDistances, TheTableHasARowASpeedAndTheLongestWay) {
  const std::vector<StopDistance> stops{{StopTrigger::EStop, 1, 0.498, 0.41, 0.11},
                                        {StopTrigger::EStop, 2, 0.503, 0.45, 0.13},
                                        {StopTrigger::LineCut, 1, 0.21, 2.2, 0.45}};
  const std::string table = stop_distance_table(stops, Config{});
  EXPECT_THAT(table, testing::HasSubstr("| 0.5 | 0.17 | 0.13 m, 0.45 s | | | |"));
  EXPECT_THAT(table, testing::HasSubstr("| 0.2 | 0.03 | | | | 0.45 m, 2.20 s |"));
}

TEST(StopDistances, SpeedsEndAtTheLimit) {
  Config config;
  config.gate.v_max_m_s = 0.45;
  EXPECT_THAT(stop_speeds_m_s(config),
              testing::ElementsAre(testing::DoubleNear(0.2, 1e-9), testing::DoubleNear(0.3, 1e-9),
                                   testing::DoubleNear(0.4, 1e-9), testing::DoubleNear(0.45, 1e-9)));
}

}  // namespace
}  // namespace heel::evaluation
