// The motion commands against closed forms: ramps, arcs, trapezoids, limits.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using test::fast_exact_settings;
using test::from_hex;
using test::VirtualClient;

using arcos::CommandId;
constexpr double kDegree = std::numbers::pi / 180.0;

/// A fast line, so that commands arrive within a millisecond of being sent.
class P3AtMotion : public testing::Test {
 protected:
  void SetUp() override { client.open_and_enable(); }
  RobotTruth truth() const { return client.robot.truth(); }
  /// Milliseconds until `done(truth)`, at most `most`; time is fed.
  template <typename Done>
  int ms_until(int most, Done done) {
    for (int ms = 0; ms < most; ++ms) {
      if (done(truth())) return ms;
      if (ms % 500 == 0) client.command(CommandId::Pulse);
      client.run_ms(1);
    }
    return most;
  }

  VirtualClient client{fast_exact_settings()};
};

TEST_F(P3AtMotion, AcceleratesAtSetAAndReachesTheSetpoint) {
  client.command(CommandId::SetA, 500);
  client.command(CommandId::Vel, 400);
  EXPECT_NEAR(ms_until(3000, [](const RobotTruth& t) { return t.v_m_s >= 0.2; }), 400, 4);
  EXPECT_NEAR(ms_until(3000, [](const RobotTruth& t) { return t.v_m_s >= 0.4 - 1e-9; }), 400, 3);
  // v²/2a on the ramp, then v t.
  const double ramp_m = 0.4 * 0.4 / (2 * 0.5);
  EXPECT_NEAR(truth().pose.x_m, ramp_m, 0.001);
  client.run_fed_ms(2000);
  EXPECT_NEAR(truth().pose.x_m, ramp_m + 0.8, 0.002);
  EXPECT_EQ(truth().pose.y_m, 0.0);
}

TEST_F(P3AtMotion, ANegativeSetAIsTheDeceleration) {
  client.send_hex("fafb06051b58025d1d");  // SETA −600: 1B and the magnitude
  client.command(CommandId::SetA, 300);
  client.command(CommandId::Vel, 600);
  EXPECT_NEAR(ms_until(4000, [](const RobotTruth& t) { return t.v_m_s >= 0.6 - 1e-9; }), 2000, 5);
  const double x_m = truth().pose.x_m;
  client.command(CommandId::Stop);
  EXPECT_NEAR(ms_until(4000, [](const RobotTruth& t) { return t.v_m_s == 0.0; }), 1000, 5);
  EXPECT_NEAR(truth().pose.x_m - x_m, 0.6 * 0.6 / (2 * 0.6), 0.002);
  EXPECT_TRUE(truth().motors_enabled) << "STOP keeps the motors on";
}

TEST_F(P3AtMotion, ReversingDeceleratesToZeroBeforeItAccelerates) {
  client.command(CommandId::SetA, 200);
  client.command(CommandId::SetA, -800);
  client.command(CommandId::Vel, 400);
  client.run_fed_ms(2500);
  client.command(CommandId::Vel, -200);
  EXPECT_NEAR(ms_until(3000, [](const RobotTruth& t) { return t.v_m_s <= 0.0; }), 500, 5);
  EXPECT_NEAR(ms_until(3000, [](const RobotTruth& t) { return t.v_m_s <= -0.2 + 1e-9; }), 1000, 5);
}

TEST_F(P3AtMotion, EStopOverridesTheDeceleration) {
  client.command(CommandId::Vel, 600);
  client.run_fed_ms(2500);
  client.command(CommandId::EStop);
  EXPECT_LE(ms_until(3000, [](const RobotTruth& t) { return t.v_m_s == 0.0; }), 110);
  EXPECT_TRUE(truth().motors_enabled);
}

TEST_F(P3AtMotion, AnAccelerationOfZeroIsIgnored) {
  client.command(CommandId::SetA, 0);
  client.command(CommandId::SetRa, 0);
  client.command(CommandId::Vel, 300);
  client.run_fed_ms(1100);
  EXPECT_NEAR(truth().v_m_s, 0.3, 1e-9);
}

TEST_F(P3AtMotion, SpeedIsClampedToSetVAndSetVToTheTop) {
  client.command(CommandId::SetV, 250);
  client.command(CommandId::Vel, 700);
  client.run_fed_ms(3000);
  EXPECT_NEAR(truth().v_m_s, 0.25, 1e-9);
  client.command(CommandId::SetV, 5000);
  client.command(CommandId::Vel, 4000);
  client.run_fed_ms(5000);
  EXPECT_NEAR(truth().v_m_s, 1.2, 1e-9);
}

TEST_F(P3AtMotion, RotationIsClampedToSetRvAndRampsAtSetRa) {
  client.command(CommandId::SetRv, 40);
  client.command(CommandId::SetRa, 80);
  client.command(CommandId::RVel, 90);
  EXPECT_NEAR(ms_until(3000, [](const RobotTruth& t) { return t.yaw_rate_rad_s >= 40 * kDegree - 1e-9; }),
              500, 4);
  client.send_hex("fafb06151b0a001f1b");  // RVEL −10 deg/s, the reference's bytes
  client.run_fed_ms(2000);
  EXPECT_NEAR(truth().yaw_rate_rad_s, -10 * kDegree, 1e-9);
}

TEST_F(P3AtMotion, VelAndRvelDriveAnArc) {
  client.command(CommandId::Vel, 300);
  client.command(CommandId::RVel, 20);
  client.run_fed_ms(2000);  // both ramps over
  const RobotTruth start = truth();
  client.run_fed_ms(3000);
  const RobotTruth end = truth();
  const double turn_rad = 3.0 * 20 * kDegree;
  const double radius_m = 0.3 / (20 * kDegree);
  EXPECT_NEAR(end.pose.heading_rad - start.pose.heading_rad, turn_rad, 1e-6);
  const double h0 = start.pose.heading_rad, h1 = h0 + turn_rad;
  EXPECT_NEAR(end.pose.x_m - start.pose.x_m, radius_m * (std::sin(h1) - std::sin(h0)), 1e-5);
  EXPECT_NEAR(end.pose.y_m - start.pose.y_m, -radius_m * (std::cos(h1) - std::cos(h0)), 1e-5);
}

TEST_F(P3AtMotion, Vel2IsTheTwoWheelsLeftInTheHighByte) {
  client.send_hex("fafb06201bf604161f");  // left −100, right +200, the reference's bytes
  client.run_fed_ms(3000);
  EXPECT_NEAR(truth().wheels.left_m_s, -0.1, 1e-9);
  EXPECT_NEAR(truth().wheels.right_m_s, 0.2, 1e-9);
  EXPECT_NEAR(truth().yaw_rate_rad_s, 0.3 / 0.588, 1e-9);
}

TEST_F(P3AtMotion, MoveIsATrapezoidThatEndsWhereItShould) {
  client.command(CommandId::SetV, 400);
  client.command(CommandId::Move, 1000);
  // Ramps of 0.4 m/s at 0.3 m/s² take 1.333 s and 0.267 m each; 0.467 m remain at 0.4 m/s.
  const int ms = ms_until(8000, [](const RobotTruth& t) { return t.pose.x_m > 0.1 && t.v_m_s == 0.0; });
  EXPECT_NEAR(ms, 2 * 1333 + 1167, 30);
  EXPECT_NEAR(truth().pose.x_m, 1.0, 0.0005);
  client.command(CommandId::Move, -250);
  client.run_fed_ms(4000);
  EXPECT_NEAR(truth().pose.x_m, 0.75, 0.0005);
}

TEST_F(P3AtMotion, HeadIsAbsoluteDheadFromHereDcheadFromTheLastSetpoint) {
  const auto heading_deg = [this] { return truth().pose.heading_rad / kDegree; };
  client.command(CommandId::Head, 90);
  client.run_fed_ms(4000);
  EXPECT_NEAR(heading_deg(), 90.0, 0.02);
  client.command(CommandId::DHead, -30);
  client.run_fed_ms(3000);
  EXPECT_NEAR(heading_deg(), 60.0, 0.02);
  client.command(CommandId::Head, 100);
  client.run_ms(200);  // on its way
  client.command(CommandId::DcHead, 20);
  client.run_fed_ms(4000);
  EXPECT_NEAR(heading_deg(), 120.0, 0.02);
  client.command(CommandId::Head, 100);
  client.run_ms(200);
  const double here_deg = heading_deg();
  client.command(CommandId::DHead, -10);
  client.run_fed_ms(4000);
  EXPECT_NEAR(heading_deg(), here_deg - 10.0, 1.0);
}

TEST_F(P3AtMotion, HeadTurnsTheShorterWay) {
  client.command(CommandId::Head, 170);
  client.run_fed_ms(5000);
  client.command(CommandId::Head, -170);
  client.run_fed_ms(3000);
  EXPECT_NEAR(truth().pose.heading_rad / kDegree, 190.0, 0.02);
}

TEST_F(P3AtMotion, HeadTakesTheTrapezoidsTime) {
  client.command(CommandId::SetRv, 60);
  client.command(CommandId::Head, 90);
  // Ramps of 60 deg/s at 100 deg/s²: 0.6 s and 18 deg each; 54 deg remain at 60 deg/s.
  const int ms = ms_until(5000, [](const RobotTruth& t) {
    return std::abs(t.pose.heading_rad - 90 * kDegree) < 1e-3 && t.yaw_rate_rad_s == 0.0;
  });
  EXPECT_NEAR(ms, 2100, 30);
}

TEST_F(P3AtMotion, SetOZeroesOdometryAndKeepsTheHeadingHeld) {
  client.command(CommandId::Vel, 200);
  client.run_fed_ms(1000);
  client.command(CommandId::Stop);
  client.command(CommandId::Head, 45);
  client.run_fed_ms(4000);
  client.send_hex("fafb04073b073b");  // as p2os sends it: a lone type byte
  client.run_fed_ms(2000);
  EXPECT_NEAR(truth().pose.heading_rad, 45 * kDegree, 0.001) << "SETO made it turn";
  EXPECT_NEAR(truth().odometry.x_m, 0.0, 1e-6);
  EXPECT_NEAR(truth().odometry.heading_rad, 0.0, 0.001);
  client.command(CommandId::Head, 10);
  client.run_fed_ms(3000);
  EXPECT_NEAR(truth().pose.heading_rad, 55 * kDegree, 0.001);
}

TEST_F(P3AtMotion, EnableZeroLetsItRollOutAndTheSetpointWaitsForEnable) {
  client.command(CommandId::Vel, 300);
  client.run_fed_ms(2000);
  client.command(CommandId::Enable, 0);
  client.run_ms(200);
  EXPECT_EQ(truth().v_m_s, 0.0);
  EXPECT_EQ(client.last_sip().flags & arcos::kFlagMotorsEnabled, 0);
  client.run_fed_ms(1000);
  EXPECT_EQ(truth().v_m_s, 0.0);
  client.command(CommandId::Enable, 1);
  client.run_fed_ms(1500);
  EXPECT_NEAR(truth().v_m_s, 0.3, 1e-9) << "a client that sends no zero first drives off";
}

TEST(P3AtMotorsOff, NothingMovesBeforeEnable) {
  VirtualClient client(fast_exact_settings());
  client.open();
  client.command(CommandId::Vel, 300);
  client.command(CommandId::RVel, 30);
  client.run_fed_ms(2000);
  EXPECT_EQ(client.robot.true_pose().x_m, 0.0);
  EXPECT_EQ(client.robot.true_pose().heading_rad, 0.0);
  EXPECT_EQ(client.last_sip().flags & arcos::kFlagMotorsEnabled, 0);
  client.command(CommandId::Vel, 0);
  client.command(CommandId::RVel, 0);
  client.command(CommandId::Enable, 1);
  client.run_fed_ms(1000);
  EXPECT_EQ(client.last_sip().flags & arcos::kFlagMotorsEnabled, 1);
  EXPECT_EQ(client.robot.true_pose().x_m, 0.0);
}

TEST(P3AtSteps, ResultsDoNotDependOnHowOftenItIsAdvanced) {
  const auto drive_with_steps_of = [](TimeNs step_ns) {
    P3At robot(P3AtSettings{}, 7);
    std::vector<std::uint8_t> out;
    const std::vector<const char*> script{"fafb03000000",       "fafb03010001",       "fafb03020002",
                                          "fafb06013b0100023b", "fafb06043b0100053b", "fafb060b3bfa00053b"};
    for (TimeNs t_ns = 0; t_ns <= 4 * kNsPerS; t_ns += step_ns) {
      robot.advance(t_ns);
      const auto index = static_cast<std::size_t>(t_ns / (100 * kNsPerMs));
      if (t_ns % (100 * kNsPerMs) == 0 && index < script.size()) robot.receive(from_hex(script[index]), t_ns);
      const std::vector<std::uint8_t> bytes = robot.take_output();
      out.insert(out.end(), bytes.begin(), bytes.end());
    }
    return std::pair(out, robot.true_pose());
  };
  const auto [bytes, pose] = drive_with_steps_of(100 * kNsPerUs);
  EXPECT_GT(pose.x_m, 0.3);
  for (const TimeNs step_ns : {kNsPerMs, 20 * kNsPerMs, 100 * kNsPerMs}) {
    const auto [other_bytes, other_pose] = drive_with_steps_of(step_ns);
    EXPECT_EQ(bytes, other_bytes);
    EXPECT_EQ(pose.x_m, other_pose.x_m);
    EXPECT_EQ(pose.y_m, other_pose.y_m);
    EXPECT_EQ(pose.heading_rad, other_pose.heading_rad);
  }
}

}  // namespace
}  // namespace heel::sim
