// The firmware's watchdog: two seconds without a command stop the robot, and the next command, whatever it
// is, brings the old motion back.
#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using test::exact_settings;
using test::VirtualClient;

using arcos::CommandId;

/// Driving at 300 mm/s, last command sent at `t_ns` of the client.
VirtualClient driving(const P3AtSettings& settings = exact_settings()) {
  VirtualClient client(settings);
  client.open_and_enable();
  client.command(CommandId::Vel, 300);
  return client;
}

double speed(const VirtualClient& client) {
  return client.robot.truth().v_m_s;
}

TEST(P3AtWatchdog, StopsTwoSecondsAfterTheLastCommand) {
  VirtualClient client = driving();
  const TimeNs t_sent_ns = client.t_ns;
  client.run_ms(2005);
  EXPECT_NEAR(speed(client), 0.3, 1e-9) << "the last command took 9.4 ms to arrive";
  client.run_ms(10);
  EXPECT_LT(speed(client), 0.3);
  // From 0.3 m/s at the set 0.3 m/s²: one more second.
  client.run_ms(950);
  EXPECT_GT(speed(client), 0.0);
  client.run_ms(60);
  EXPECT_EQ(speed(client), 0.0);
  EXPECT_NEAR(seconds_from_ns(client.time_of(RobotEventKind::WatchdogStop) - t_sent_ns), 2.0094, 0.002);
  EXPECT_TRUE(client.robot.truth().motors_enabled) << "the watchdog does not switch motors off";
  EXPECT_TRUE(client.robot.truth().watchdog_stopped);
}

TEST(P3AtWatchdog, IsFedByAnyCommandEvenAnUnknownOne) {
  for (const char* hex : {"fafb03000000", "fafb03010001", "fafb03c800c8", "fafb061c3b01001d3b"}) {
    VirtualClient client = driving();
    for (int i = 0; i < 4; ++i) {
      client.run_ms(1500);
      client.send_hex(hex);
    }
    client.run_ms(1000);
    EXPECT_NEAR(speed(client), 0.3, 1e-9) << hex;
  }
}

TEST(P3AtWatchdog, IsNotFedByBrokenPackets) {
  VirtualClient client = driving();
  for (int i = 0; i < 30; ++i) {
    client.send_hex("fafb03000001");  // wrong checksum
    client.run_ms(100);
  }
  EXPECT_TRUE(client.happened(RobotEventKind::WatchdogStop));
}

TEST(P3AtWatchdog, ABarePulseResumesTheOldMotion) {
  VirtualClient client = driving();
  client.command(CommandId::RVel, 10);
  client.run_ms(4000);
  EXPECT_EQ(speed(client), 0.0);
  client.send_hex("fafb03000000");  // PULSE, or the SYNC0 of a client that does not know
  client.run_ms(1500);
  EXPECT_NEAR(speed(client), 0.3, 1e-9);
  EXPECT_NEAR(client.robot.truth().yaw_rate_rad_s, 10.0 * 3.14159265 / 180.0, 1e-6);
  EXPECT_TRUE(client.happened(RobotEventKind::WatchdogResume));
}

TEST(P3AtWatchdog, AStopAsTheFirstCommandKeepsItStanding) {
  for (const CommandId id : {CommandId::Stop, CommandId::EStop, CommandId::Close}) {
    VirtualClient client = driving();
    client.run_ms(4000);
    const double x_m = client.robot.true_pose().x_m;
    client.command(id);
    client.run_ms(100);
    client.send_hex("fafb03000000");
    client.run_ms(1500);
    EXPECT_EQ(speed(client), 0.0);
    EXPECT_EQ(client.robot.true_pose().x_m, x_m);
  }
}

TEST(P3AtWatchdog, ResumesAMoveUnderWay) {
  VirtualClient client(exact_settings());
  client.open_and_enable();
  client.command(CommandId::Move, 1500);
  client.run_ms(5000);
  EXPECT_EQ(speed(client), 0.0);
  EXPECT_LT(client.robot.true_pose().x_m, 1.4);
  client.run_fed_ms(8000);
  EXPECT_NEAR(client.robot.true_pose().x_m, 1.5, 0.001);
}

TEST(P3AtWatchdog, SleepsBeforeOpenAndWhenSetToZero) {
  VirtualClient connected(exact_settings());
  connected.sync();
  connected.run_ms(5000);
  EXPECT_FALSE(connected.happened(RobotEventKind::WatchdogStop));

  P3AtSettings settings = exact_settings();
  settings.watchdog_ns = 0;
  VirtualClient never = driving(settings);
  never.run_ms(10000);
  EXPECT_NEAR(speed(never), 0.3, 1e-9);
}

TEST(P3AtWatchdog, ARobotLeftOpenInMotionGoesOnWithTheFirstByteItUnderstands) {
  P3AtSettings settings = exact_settings();
  settings.faults.push_back({.kind = FaultKind::LeftOpen, .t_ns = 0, .duration_ns = 0, .amount = 400.0});
  VirtualClient client(settings);
  client.run_ms(1000);
  EXPECT_GE(client.sips().size(), 8u);
  EXPECT_EQ(client.robot.true_pose().x_m, 0.0);
  client.send_hex("fafb03000000");
  client.run_ms(1500);
  EXPECT_NEAR(speed(client), 0.4, 1e-9);
}

}  // namespace
}  // namespace heel::sim
