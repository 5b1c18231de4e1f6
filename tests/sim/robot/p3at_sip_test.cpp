// What the standard information packet says: position and its wrap, flags, bumpers, stalls, the tail.
#include <numbers>

#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using test::fast_exact_settings;
using test::VirtualClient;

using arcos::CommandId;

arcos::Sip sip_after(VirtualClient& client, int ms = 250) {
  client.run_fed_ms(ms);
  return client.last_sip();
}

TEST(P3AtSipMotion, IdTellsStandingFromMoving) {
  VirtualClient client(fast_exact_settings());
  client.open_and_enable();
  EXPECT_EQ(sip_after(client).id, 0x32);
  client.command(CommandId::Vel, 200);
  const arcos::Sip moving = sip_after(client, 1500);
  EXPECT_EQ(moving.id, 0x33);
  EXPECT_EQ(moving.left_mm_s, 200);
  EXPECT_EQ(moving.right_mm_s, 200);
  client.command(CommandId::Stop);
  EXPECT_EQ(sip_after(client, 1500).id, 0x32);
}

TEST(P3AtSipMotion, TurningShowsInWheelsAndRotationalVelocity) {
  VirtualClient client(fast_exact_settings());
  client.open_and_enable();
  client.command(CommandId::RVel, 20);
  const arcos::Sip sip = sip_after(client, 1500);
  const double wheel_mm_s = 20.0 * std::numbers::pi / 180.0 * 588.0 / 2.0;
  EXPECT_NEAR(sip.right_mm_s, wheel_mm_s, 1.0);
  EXPECT_NEAR(sip.left_mm_s, -wheel_mm_s, 1.0);
  EXPECT_EQ(sip.rotation_ddeg_s, 200);
}

class P3AtPositionUnits : public testing::TestWithParam<double> {};

TEST_P(P3AtPositionUnits, WrapNaturallyIn16Bits) {
  const double mm_per_unit = GetParam();
  P3AtSettings settings = fast_exact_settings();
  settings.model.mm_per_position_unit = mm_per_unit;
  VirtualClient client(settings);
  client.open_and_enable();
  client.command(CommandId::Vel, -500);
  client.run_fed_ms(6000);  // below zero: just under 65536
  arcos::Sip sip = client.last_sip();
  EXPECT_GT(sip.x_pos, 58000);
  EXPECT_NEAR(static_cast<std::int16_t>(sip.x_pos), client.robot.truth().odometry.x_m * 1000.0 / mm_per_unit,
              55.0 / mm_per_unit);
  client.command(CommandId::SetV, 1200);
  client.command(CommandId::SetA, 1000);
  client.command(CommandId::Vel, 1200);
  client.run_fed_ms(62000);  // past 65.5 m
  sip = client.last_sip();
  const double units = client.robot.truth().odometry.x_m * 1000.0 / mm_per_unit;
  ASSERT_GT(units, 65536.0);
  EXPECT_NEAR(std::remainder(sip.x_pos - units, 65536.0), 0.0, 125.0 / mm_per_unit);
}

INSTANTIATE_TEST_SUITE_P(Factors, P3AtPositionUnits, testing::Values(1.0, 0.465), [](const auto& factor) {
  return std::to_string(std::lround(factor.param * 1000)) + "MicrometresPerUnit";
});

TEST(P3AtSipHeading, IsSignedOrCountsFromZeroAsConfigured) {
  for (const bool from_zero : {false, true}) {
    P3AtSettings settings = fast_exact_settings();
    settings.heading_from_zero = from_zero;
    VirtualClient client(settings);
    client.open_and_enable();
    client.command(CommandId::Head, -90);
    const arcos::Sip sip = sip_after(client, 4000);
    EXPECT_NEAR(sip.th_pos, from_zero ? 3072 : -1024, 1);
    EXPECT_NEAR(sip.control, from_zero ? 3072 : -1024, 1);
  }
}

TEST(P3AtSipHeading, CompassCountsClockwiseInTwoDegrees) {
  P3AtSettings settings = fast_exact_settings();
  settings.start.heading_rad = std::numbers::pi / 2.0;
  VirtualClient client(settings);
  client.open();
  EXPECT_EQ(sip_after(client).compass_2deg, 135);
}

TEST(P3AtSipTail, HoldsBatteryChargeDigitalAndFaultFlags) {
  P3AtSettings settings = fast_exact_settings();
  settings.battery_v = 12.5;
  settings.charge_state = 3;
  VirtualClient client(settings);
  client.open();
  client.send(arcos::encode_digout(0x0F, 0x05));
  client.command(CommandId::AdSel, 3);
  const arcos::Sip sip = sip_after(client);
  EXPECT_EQ(sip.battery_dv, 125);
  EXPECT_EQ(sip.battery_long_dv, 125);
  EXPECT_EQ(sip.charge_state, 3);
  EXPECT_EQ(sip.digital_out, 5);
  EXPECT_EQ(sip.ad_port, 3);
  EXPECT_TRUE(sip.fault_flags.has_value());
  EXPECT_NE(sip.flags & arcos::kFlagPowerGood, 0);

  client.command(CommandId::BatTest, 110);
  EXPECT_EQ(sip_after(client).battery_dv, 110);

  settings.sends_fault_flags = false;
  VirtualClient older(settings);
  older.open();
  EXPECT_FALSE(sip_after(older).fault_flags.has_value());
}

TEST(P3AtSipTail, TheBatteryDrains) {
  P3AtSettings settings = fast_exact_settings();
  settings.battery_drain_v_per_h = 36.0;
  VirtualClient client(settings);
  client.open();
  EXPECT_NEAR(sip_after(client, 60000).battery_dv, 128 - 6, 1);
}

// ── bumpers, stalls, buttons ──

TEST(P3AtBumpers, ShowTheirSegmentsFrontHighRearLow) {
  VirtualClient client(fast_exact_settings());
  client.open();
  client.robot.touch_bumper(0b0000101, 0b1000000);
  const arcos::Sip sip = sip_after(client);
  EXPECT_EQ(sip.stall_and_bumpers, 0x0A80);
  EXPECT_EQ(sip.bumpers_front(), 0b0000101);
  EXPECT_EQ(sip.bumpers_rear(), 0b1000000);
  client.robot.touch_bumper(0, 0);
  EXPECT_EQ(sip_after(client).stall_and_bumpers, 0);
}

struct BumpCase {
  int bump_stall;
  int speed_mm_s;
  bool front;
  bool stalls;

  std::string name() const {
    return "BumpStall" + std::to_string(bump_stall) + (speed_mm_s > 0 ? "Forward" : "Backward") +
           (front ? "FrontBumper" : "RearBumper");
  }
};
void PrintTo(const BumpCase& bump, std::ostream* out) {
  *out << (bump.stalls ? "stalls" : "drives on");
}
class P3AtBumpStall : public testing::TestWithParam<BumpCase> {};

TEST_P(P3AtBumpStall, StopsTheRobotOnlyInTheDirectionOfTheBumper) {
  const BumpCase bump = GetParam();
  VirtualClient client(fast_exact_settings());
  client.open_and_enable();
  client.command(CommandId::BumpStall, bump.bump_stall);
  client.command(CommandId::Vel, bump.speed_mm_s);
  client.run_fed_ms(1500);
  client.robot.touch_bumper(bump.front ? 1 : 0, bump.front ? 0 : 1);
  const arcos::Sip sip = sip_after(client, 400);
  EXPECT_EQ(sip.stall_left() && sip.stall_right(), bump.stalls);
  EXPECT_EQ(client.robot.truth().v_m_s == 0.0, bump.stalls);
  client.robot.touch_bumper(0, 0);
  client.run_fed_ms(1500);
  EXPECT_NEAR(client.robot.truth().v_m_s, bump.speed_mm_s * 1e-3, 1e-9) << "it goes on when let go";
}

INSTANTIATE_TEST_SUITE_P(Table, P3AtBumpStall,
                         testing::Values(BumpCase{0, 300, true, false}, BumpCase{0, -300, false, false},
                                         BumpCase{1, 300, true, true}, BumpCase{1, -300, false, false},
                                         BumpCase{1, -300, true, false}, BumpCase{2, 300, true, false},
                                         BumpCase{2, -300, false, true}, BumpCase{2, 300, false, false},
                                         BumpCase{3, 300, true, true}, BumpCase{3, -300, false, true}),
                         [](const auto& bump) { return bump.param.name(); });

TEST(P3AtStall, ABlockedWheelCutsPowerAfterHalfASecondAndTriesAgain) {
  VirtualClient client(fast_exact_settings());
  client.open_and_enable();
  client.command(CommandId::Vel, 300);
  client.run_fed_ms(1500);
  client.robot.block_wheels(true, false);
  client.run_ms(490);
  EXPECT_FALSE(client.robot.truth().stall_left);
  EXPECT_GT(client.robot.truth().wheels.right_m_s, 0.2) << "the free wheel goes on";
  client.run_ms(20);
  EXPECT_TRUE(client.robot.truth().stall_left);
  EXPECT_FALSE(client.robot.truth().stall_right);
  const arcos::Sip sip = sip_after(client, 120);
  EXPECT_TRUE(sip.stall_left());
  EXPECT_FALSE(sip.stall_right());
  client.robot.block_wheels(false, false);
  client.run_fed_ms(2000);
  EXPECT_NEAR(client.robot.truth().v_m_s, 0.3, 1e-9);
  EXPECT_FALSE(client.robot.truth().stall_left);
}

TEST(P3AtStall, TwoShortPushesAreNotOneLongOne) {
  VirtualClient client(fast_exact_settings());
  client.open_and_enable();
  client.command(CommandId::Vel, 300);
  client.run_fed_ms(1500);
  for (int i = 0; i < 4; ++i) {
    client.robot.block_wheels(true, true);
    client.run_ms(300);
    client.robot.block_wheels(false, false);
    client.run_ms(150);
  }
  EXPECT_FALSE(client.happened(RobotEventKind::Stalled));
}

TEST(P3AtStall, StandingAgainstAWallWithoutPushingIsNone) {
  VirtualClient client(fast_exact_settings());
  client.open_and_enable();
  client.robot.block_wheels(true, true);
  client.run_fed_ms(3000);
  EXPECT_FALSE(client.happened(RobotEventKind::Stalled));
}

TEST(P3AtStopButton, SwitchesMotorsOffUntilAnExplicitEnable) {
  VirtualClient client(fast_exact_settings());
  client.open_and_enable();
  client.command(CommandId::Vel, 300);
  client.run_fed_ms(1500);
  client.robot.press_stop_button(true);
  arcos::Sip sip = sip_after(client);
  EXPECT_EQ(sip.flags & (arcos::kFlagMotorsEnabled | arcos::kFlagStopButton), arcos::kFlagStopButton);
  EXPECT_EQ(sip.flags & arcos::kFlagEStall, 0);
  EXPECT_EQ(client.robot.truth().v_m_s, 0.0);
  client.command(CommandId::Enable, 1);
  EXPECT_EQ(sip_after(client).flags & arcos::kFlagMotorsEnabled, 0) << "enabled under a held button";
  client.robot.press_stop_button(false);
  sip = sip_after(client, 1000);
  EXPECT_EQ(sip.flags & (arcos::kFlagMotorsEnabled | arcos::kFlagStopButton), 0);
  EXPECT_EQ(client.robot.truth().v_m_s, 0.0);
  client.command(CommandId::Enable, 1);
  EXPECT_EQ(sip_after(client).flags & arcos::kFlagMotorsEnabled, arcos::kFlagMotorsEnabled);
}

TEST(P3AtStopButton, WithEStallItStallsToo) {
  VirtualClient client(fast_exact_settings());
  client.open_and_enable();
  client.command(CommandId::EStall, 1);
  client.run_ms(50);
  client.robot.press_stop_button(true);
  client.run_ms(50);
  client.robot.press_stop_button(false);
  arcos::Sip sip = sip_after(client);
  EXPECT_EQ(sip.flags & (arcos::kFlagMotorsEnabled | arcos::kFlagEStall), arcos::kFlagEStall);
  EXPECT_TRUE(sip.stall_left() && sip.stall_right());
  client.command(CommandId::Enable, 1);
  sip = sip_after(client);
  EXPECT_EQ(sip.flags & (arcos::kFlagMotorsEnabled | arcos::kFlagEStall), arcos::kFlagMotorsEnabled);
  EXPECT_FALSE(sip.stall_left() || sip.stall_right());
}

}  // namespace
}  // namespace heel::sim
