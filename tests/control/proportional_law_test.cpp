// The laws "view" and "position": signs one by one, how the two relate, and the closed loop on an exact
// unicycle.
#include "control/proportional_law.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <numbers>

#include "core/angles.h"
#include "core/random.h"
#include "estimate/floor_truth.h"

namespace heel {
namespace {

constexpr double kDistance_m = 2.0;

struct Law {
  Config config;
  YawGain yaw_gain = YawGain::FromConfiguration;

  CameraMount mount() const { return mount_of(config.camera); }
  /// The exact target of a person in the robot frame.
  TargetState target(double x_m, double y_m, double yaw_rad) const {
    TargetState t;
    t.known = true;
    t.x_m = x_m;
    t.y_m = y_m;
    t.travel_yaw_rad = yaw_rad;
    const double behind_m = kDistance_m + mount().x_m;
    t.goal_x_m = x_m - behind_m * std::cos(yaw_rad + config.control.setpoint_yaw_rad);
    t.goal_y_m = y_m - behind_m * std::sin(yaw_rad + config.control.setpoint_yaw_rad);
    return t;
  }
  WantedVelocity operator()(const TargetState& target) const {
    const RobotState robot;
    return ProportionalLaw(config, yaw_gain)
        .velocity({kNsPerS, target, robot, SonarObstacles(RobotGeometry{})});
  }
  double rest_x_m() const { return kDistance_m + mount().x_m; }
};

TEST(ViewLaw, RestsInTheReferenceView) {
  const Law law;
  const auto command = law(law.target(law.rest_x_m(), 0, 0));
  EXPECT_NEAR(command.v_m_s, 0.0, 1e-12);
  EXPECT_NEAR(command.yaw_rate_rad_s, 0.0, 1e-12);
}

TEST(ViewLaw, DrivesWhenThePersonIsFarAndRestsWhenNear) {
  Law law;
  EXPECT_GT(law(law.target(law.rest_x_m() + 0.5, 0, 0)).v_m_s, 0.0);
  EXPECT_EQ(law(law.target(law.rest_x_m() - 0.5, 0, 0)).v_m_s, 0.0);
  law.config.control.reverse = true;
  EXPECT_LT(law(law.target(law.rest_x_m() - 0.5, 0, 0)).v_m_s, 0.0);
}

TEST(ViewLaw, ErrorsInTheDeadbandDoNotMoveIt) {
  Law law;
  law.config.control.reverse = true;
  law.config.control.deadband_distance_m = 0.1;
  EXPECT_EQ(law(law.target(law.rest_x_m() + 0.09, 0, 0)).v_m_s, 0.0);
  EXPECT_EQ(law(law.target(law.rest_x_m() - 0.09, 0, 0)).v_m_s, 0.0);
  EXPECT_NEAR(law(law.target(law.rest_x_m() + 0.11, 0, 0)).v_m_s, 0.01, 1e-9);  // no step at the edge
}

TEST(ViewLaw, TurnsTowardsThePersonsSide) {
  const Law law;
  EXPECT_GT(law(law.target(law.rest_x_m(), 0.3, 0)).yaw_rate_rad_s, 0.0);   // left
  EXPECT_LT(law(law.target(law.rest_x_m(), -0.3, 0)).yaw_rate_rad_s, 0.0);  // right
}

TEST(ViewLaw, YawGainTurnsTheWayThePersonTurns) {
  Law law;
  law.config.control.gain_lateral_rad_s_m = 0.0;
  EXPECT_GT(law(law.target(law.rest_x_m(), 0, 0.2)).yaw_rate_rad_s, 0.0);
  EXPECT_LT(law(law.target(law.rest_x_m(), 0, -0.2)).yaw_rate_rad_s, 0.0);
}

TEST(ViewLaw, TheBearingLimitCountsFromTheCameraWhereverItIsMounted) {
  for (const double mount_y_m : {-0.2, 0.0, 0.2}) {
    for (const double side : {-1.0, 1.0}) {
      Law law;
      law.config.camera.mount_y_m = mount_y_m;
      law.config.control.gain_lateral_rad_s_m = 0.0;
      law.config.control.gain_yaw_1_s = 0.0;
      const double bearing_rad = side * (law.config.control.bearing_max_rad + 0.1);
      const auto command = law(law.target(law.mount().x_m + 2.0 * std::cos(bearing_rad),
                                          mount_y_m + 2.0 * std::sin(bearing_rad), 0.0));
      // The robot drives past the person, which adds v sin(bearing) / range to the rate.
      EXPECT_NEAR(
          command.yaw_rate_rad_s,
          side * 0.1 * law.config.control.bearing_gain_1_s + command.v_m_s * std::sin(bearing_rad) / 2.0,
          1e-9)
          << mount_y_m << " " << side;
    }
  }
}

TEST(PositionLaw, IsTheViewLawWithTheGainThatCancelsYaw) {
  Law position, view;
  position.yaw_gain = YawGain::CancelsYaw;
  for (Law* law : {&position, &view}) {
    law->config.control.gain_lateral_rad_s_m = 1.3;
    law->config.control.setpoint_yaw_rad = 0.2;
  }
  view.config.control.gain_yaw_1_s = 1.3 * view.rest_x_m();
  Random random(11);
  for (int i = 0; i < 1000; ++i) {
    const TargetState target =
        view.target(random.uniform(1.0, 5.0), random.uniform(-2.0, 2.0), random.uniform(-1.5, 1.5));
    ASSERT_NEAR(position(target).v_m_s, view(target).v_m_s, 1e-12);
    ASSERT_NEAR(position(target).yaw_rate_rad_s, view(target).yaw_rate_rad_s, 1e-12);
  }
}

TEST(PositionLaw, TurnsByThePositionWhateverThePersonsYaw) {
  Law law;
  law.yaw_gain = YawGain::CancelsYaw;
  law.config.control.gain_lateral_rad_s_m = 1.3;
  law.config.control.gain_yaw_1_s = 99.0;  // of the law "view"
  for (const double yaw_rad : {-0.02, 0.0, 0.02}) {
    const auto command = law(law.target(2.5, 0.1, yaw_rad));
    EXPECT_NEAR(command.yaw_rate_rad_s, 1.3 * 0.1, 1e-4) << yaw_rad;  // k_x y, to third order in yaw
  }
}

/// A loop with an exact robot. It keeps the largest bearing of the person from the camera.
struct Loop {
  Law law;
  Pose2 robot, person;
  double person_v_m_s = 0.0;
  double worst_bearing_rad = 0.0;

  TargetState target() const {
    const Eigen::Vector2d p = test::in_robot(robot, person.x_m, person.y_m);
    return law.target(p.x(), p.y(), wrap_angle_rad(person.heading_rad - robot.heading_rad));
  }
  void run(double seconds) {
    constexpr double dt_s = 0.02;
    for (double t_s = 0.0; t_s < seconds; t_s += dt_s) {
      const TargetState seen = target();
      worst_bearing_rad = std::max(
          worst_bearing_rad, std::abs(std::atan2(seen.y_m - law.mount().y_m, seen.x_m - law.mount().x_m)));
      const auto command = law(seen);
      robot = test::moved(robot, command.v_m_s, command.yaw_rate_rad_s, dt_s);
      person = test::moved(person, person_v_m_s, 0.0, dt_s);
    }
  }
};

TEST(ViewLawLoop, ConvergesToThePathOfAWalkingPerson) {
  for (const double offset_m : {-0.5, 0.5}) {
    for (const double v_m_s : {0.3, 0.6, 1.0}) {
      Loop loop;
      loop.robot = {0.0, offset_m, 0.2};
      loop.person = {2.5, 0.0, 0.0};
      loop.person_v_m_s = v_m_s;
      loop.run(60.0);
      EXPECT_NEAR(loop.robot.y_m, 0.0, 0.01) << v_m_s;
      EXPECT_NEAR(loop.robot.heading_rad, 0.0, 0.01) << v_m_s;
      // The lag that proportional control leaves: V / k_z.
      const double lag_m = loop.target().goal_x_m - loop.law.config.control.deadband_distance_m;
      EXPECT_NEAR(lag_m, v_m_s / loop.law.config.control.gain_distance_1_s, 0.02) << v_m_s;
    }
  }
}

TEST(ViewLawLoop, LinearisedFrequencyAndDampingAreAsTheHeaderSays) {
  // Little damping, so that the loop oscillates for a whole period: k_yaw = 0, k_z large.
  Loop loop;
  loop.law.config.control.gain_yaw_1_s = 0.0;
  loop.law.config.control.gain_distance_1_s = 5.0;
  loop.law.config.control.gain_lateral_rad_s_m = 1.0;
  loop.law.config.control.bearing_max_rad = 1.5;
  loop.person_v_m_s = 0.8;
  loop.robot = {0.0, 0.02, 0.0};
  loop.person = {loop.law.rest_x_m() + 0.8 / 5.0 + loop.law.config.control.deadband_distance_m, 0.0, 0.0};
  const double damping_1_s = 0.5 * 1.0 * (0.8 / 5.0 + loop.law.config.control.deadband_distance_m);
  const double frequency_rad_s = std::sqrt(1.0 * 0.8 - damping_1_s * damping_1_s);
  loop.run(2 * std::numbers::pi / frequency_rad_s);  // one period
  EXPECT_NEAR(loop.robot.y_m, 0.02 * std::exp(-damping_1_s * 2 * std::numbers::pi / frequency_rad_s), 0.001);
}

RC_GTEST_PROP(ViewLawLoop, ThePersonNeverLeavesThePicture, ()) {
  const auto between = [](double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 10001) / 1e4;
  };
  Loop loop;
  loop.law.config.control.gain_yaw_1_s = between(0.0, 5.0);
  loop.law.config.control.gain_lateral_rad_s_m = between(0.0, 3.0);
  const double limit_rad = loop.law.config.control.bearing_max_rad;
  // A person who stands inside the picture, with any yaw.
  const double range_m = between(1.5, 5.0), bearing_rad = between(-0.9, 0.9) * limit_rad;
  loop.person = {loop.law.mount().x_m + range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad),
                 between(-1.2, 1.2)};
  // The gate would stop the robot at this range; the law has no such limit.
  for (int i = 0; i < 300 && loop.target().x_m > 1.0; ++i) loop.run(0.02);
  RC_ASSERT(loop.worst_bearing_rad < limit_rad + 0.03);
}

}  // namespace
}  // namespace heel
