// Faults on demand: their spelling, their times and what they do to the line and the robot.
#include <cmath>

#include "sim/robot/virtual_client.h"
#include "support/complaint.h"

namespace heel::sim {
namespace {

using test::exact_settings;
using test::VirtualClient;

using arcos::CommandId;

TEST(ParseFault, ReadsKindStartDurationAndAmount) {
  const Fault fault = parse_fault("drop@10.5+5=0.02");
  EXPECT_EQ(fault.kind, FaultKind::DropBytes);
  EXPECT_EQ(fault.t_ns, 10'500 * kNsPerMs);
  EXPECT_EQ(fault.duration_ns, 5 * kNsPerS);
  EXPECT_DOUBLE_EQ(fault.amount, 0.02);
  EXPECT_EQ(parse_fault("reset@3").kind, FaultKind::Reset);
  EXPECT_DOUBLE_EQ(parse_fault("boot_baud@0=38400").amount, 38400.0);
}

TEST(ParseFault, NamesWhatIsWrong) {
  const auto complaint = [](const std::string& text) {
    return test::complaint_of([&] { parse_fault(text); });
  };
  EXPECT_NE(complaint("dorp@1").find("'dorp' is not a fault (expected one of drop, garble"),
            std::string::npos);
  EXPECT_NE(complaint("drop").find("no start"), std::string::npos);
  EXPECT_NE(complaint("drop@x").find("start 'x'"), std::string::npos);
  EXPECT_NE(complaint("drop@1+-2").find("duration '-2'"), std::string::npos);
  EXPECT_NE(complaint("drop@1=1e999").find("amount '1e999'"), std::string::npos);
}

TEST(ParseFault, OfNowHasNoStart) {
  const Fault fault = parse_fault_now("drop+5=0.02", 7 * kNsPerS);
  EXPECT_EQ(fault.kind, FaultKind::DropBytes);
  EXPECT_EQ(fault.t_ns, 7 * kNsPerS);
  EXPECT_EQ(fault.duration_ns, 5 * kNsPerS);
  EXPECT_DOUBLE_EQ(fault.amount, 0.02);
  EXPECT_EQ(parse_fault_now("reset", 0).kind, FaultKind::Reset);
  EXPECT_EQ(parse_fault_duration("camera+1.5"), 1500 * kNsPerMs);
  EXPECT_NE(test::complaint_of([] { parse_fault_now("drop@1", 0); }).find("'drop@1' is not a fault"),
            std::string::npos);
}

TEST(ParseFault, EveryKindHasAName) {
  for (int kind = 0; kind <= static_cast<int>(FaultKind::LeftOpen); ++kind) {
    const std::string name = to_string(static_cast<FaultKind>(kind));
    EXPECT_EQ(fault_kind_from_name(name), static_cast<FaultKind>(kind)) << name;
  }
}

TEST(FaultSchedule, EffectsBeginAndEndOnTime) {
  FaultSchedule schedule;
  schedule.add(parse_fault("silence@2+1"));
  schedule.add(parse_fault("drop@1+5=0.5"));
  schedule.add(parse_fault("bumper@1+1=513"));
  EXPECT_TRUE(schedule.advance(999 * kNsPerMs).empty());
  EXPECT_EQ(schedule.effects().drop_share, 0.0);
  EXPECT_EQ(schedule.advance(1000 * kNsPerMs).size(), 2u);
  EXPECT_EQ(schedule.effects().drop_share, 0.5);
  EXPECT_EQ(schedule.effects().bumpers_front, 1);
  EXPECT_EQ(schedule.effects().bumpers_rear, 2);
  EXPECT_EQ(schedule.advance(2000 * kNsPerMs).size(), 1u);
  EXPECT_TRUE(schedule.effects().silence);
  EXPECT_EQ(schedule.effects().bumpers_front, 0);
  schedule.advance(3000 * kNsPerMs);
  EXPECT_FALSE(schedule.effects().silence);
  EXPECT_EQ(schedule.effects().drop_share, 0.5);
  schedule.advance(6000 * kNsPerMs);
  EXPECT_EQ(schedule.effects().drop_share, 0.0);
}

/// An open session that began undisturbed; the fault is injected now, for the rest of the run.
VirtualClient open_with_fault(FaultKind kind, double amount, TimeNs duration_ns = 0) {
  P3AtSettings settings = exact_settings();
  settings.boot_baud = 38400;
  VirtualClient client(settings);
  client.open();
  client.run_ms(100);
  client.forget();
  client.robot.inject({.kind = kind, .t_ns = client.t_ns, .duration_ns = duration_ns, .amount = amount});
  return client;
}

TEST(LineFaults, DropLosesItsShareOfTheBytes) {
  VirtualClient whole = open_with_fault(FaultKind::DropBytes, 0.0);
  VirtualClient holed = open_with_fault(FaultKind::DropBytes, 0.1);
  for (VirtualClient* client : {&whole, &holed}) client->run_fed_ms(60'000);
  const double n = static_cast<double>(whole.raw.size());
  EXPECT_NEAR(static_cast<double>(holed.raw.size()) / n, 0.9, 4.0 * std::sqrt(0.09 / n));
  EXPECT_GT(whole.sips().size(), 595u);
  EXPECT_LT(holed.sips().size(), 60u) << "0.9^50 of the SIPs arrive whole";
  EXPECT_GT(holed.sips().size(), 0u);
}

TEST(LineFaults, GarbleFlipsBitsAndKeepsTheCount) {
  VirtualClient whole = open_with_fault(FaultKind::GarbleBytes, 0.0);
  VirtualClient garbled = open_with_fault(FaultKind::GarbleBytes, 0.01);
  for (VirtualClient* client : {&whole, &garbled}) client->run_fed_ms(20'000);
  ASSERT_EQ(whole.raw.size(), garbled.raw.size());
  int different = 0;
  for (std::size_t i = 0; i < whole.raw.size(); ++i) different += whole.raw[i] != garbled.raw[i] ? 1 : 0;
  EXPECT_NEAR(different, 0.01 * static_cast<double>(whole.raw.size()), 40.0);
  EXPECT_GT(different, 0);
  EXPECT_LT(garbled.sips().size(), whole.sips().size());
  EXPECT_GT(garbled.sips().size(), whole.sips().size() / 3);
}

TEST(LineFaults, DelayHoldsBytesBackBothWays) {
  VirtualClient client = open_with_fault(FaultKind::DelayBytes, 0.3);
  client.run_ms(250);
  EXPECT_LE(client.sips().size(), 1u) << "what was already under way";
  client.run_ms(500);
  EXPECT_GE(client.sips().size(), 4u);
  client.command(CommandId::Enable, 1);
  client.run_ms(290);
  EXPECT_FALSE(client.robot.truth().motors_enabled);
  client.run_ms(20);
  EXPECT_TRUE(client.robot.truth().motors_enabled);
}

TEST(LineFaults, SilenceIsOneWayAndEnds) {
  VirtualClient client = open_with_fault(FaultKind::Silence, 0.0, 1500 * kNsPerMs);
  client.run_ms(100);
  client.forget();
  client.command(CommandId::Enable, 1);
  client.run_ms(1300);
  EXPECT_TRUE(client.raw.empty());
  EXPECT_TRUE(client.robot.truth().motors_enabled) << "it still hears";
  client.run_ms(500);
  EXPECT_GE(client.sips().size(), 3u);
}

TEST(RobotFaults, ResetBumperButtonStallAndBaudTakeEffect) {
  VirtualClient reset = open_with_fault(FaultKind::Reset, 255.0);
  reset.run_ms(200);
  EXPECT_EQ(reset.of_id(0xFF).size(), 1u);
  EXPECT_EQ(reset.robot.truth().session, Session::Waiting);

  VirtualClient bumped = open_with_fault(FaultKind::Bumper, 4.0, 500 * kNsPerMs);
  bumped.run_ms(300);
  EXPECT_EQ(bumped.last_sip().bumpers_front(), 4);
  bumped.run_ms(500);
  EXPECT_EQ(bumped.last_sip().bumpers_front(), 0);

  VirtualClient button = open_with_fault(FaultKind::StopButton, 0.0, 500 * kNsPerMs);
  button.run_ms(300);
  EXPECT_NE(button.last_sip().flags & arcos::kFlagStopButton, 0);
  button.run_ms(500);
  EXPECT_EQ(button.last_sip().flags & arcos::kFlagStopButton, 0);

  VirtualClient baud = open_with_fault(FaultKind::BootBaud, 115200.0);
  baud.run_ms(50);
  EXPECT_EQ(baud.robot.baud(), 115200);
  EXPECT_EQ(baud.robot.truth().session, Session::Waiting);
}

struct StallCase {
  const char* name;
  double amount;
  bool left, right;
};
void PrintTo(const StallCase& stall, std::ostream* out) {
  *out << "amount " << stall.amount;
}
class StallFault : public testing::TestWithParam<StallCase> {};

TEST_P(StallFault, BlocksTheWheelsNamed) {
  VirtualClient client = open_with_fault(FaultKind::Stall, GetParam().amount);
  client.command(CommandId::Enable, 1);
  client.command(CommandId::Vel, 300);
  bool left = false, right = false;
  for (int i = 0; i < 20; ++i) {
    client.run_fed_ms(100);
    left = left || client.last_sip().stall_left();
    right = right || client.last_sip().stall_right();
  }
  EXPECT_EQ(left, GetParam().left);
  EXPECT_EQ(right, GetParam().right);
}

INSTANTIATE_TEST_SUITE_P(Wheels, StallFault,
                         testing::Values(StallCase{"Both", 0, true, true}, StallCase{"Left", 1, true, false},
                                         StallCase{"Right", 2, false, true}),
                         [](const auto& stall) { return std::string(stall.param.name); });

}  // namespace
}  // namespace heel::sim
