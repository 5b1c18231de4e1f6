// The connection: sync, open, close, and what ids 0, 1 and 2 mean in each state.
#include "arcos/other_packets.h"
#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using test::exact_settings;
using test::from_hex;
using test::Received;
using test::VirtualClient;

using arcos::CommandId;

TEST(P3AtSession, EchoesTheThreeSyncsAndNamesItself) {
  P3AtSettings settings = exact_settings();
  settings.name = "Mops";
  VirtualClient client(settings);
  client.sync();
  ASSERT_EQ(client.packets.size(), 3u);
  EXPECT_EQ(client.packets[0].body, (std::vector<std::uint8_t>{0}));
  EXPECT_EQ(client.packets[1].body, (std::vector<std::uint8_t>{1}));
  const std::string echo(client.packets[2].body.begin() + 1, client.packets[2].body.end());
  EXPECT_EQ(echo, std::string("Mops\0Pioneer\0p3at-sh\0", 21));
}

TEST(P3AtSession, SendsJunkBeforeTheFirstEchoOnly) {
  VirtualClient client(exact_settings());
  client.send_hex("fafb03000000");
  client.run_ms(60);
  EXPECT_EQ(client.raw, from_hex("574d53320d"
                                 "fafb03000000"));
  client.forget();
  client.send_hex("fafb03000000");
  client.run_ms(60);
  EXPECT_EQ(client.raw, from_hex("fafb03000000"));
}

TEST(P3AtSession, IgnoresSyncsOutOfOrder) {
  VirtualClient client(exact_settings());
  client.send_hex("fafb03010001");
  client.send_hex("fafb03020002");
  client.run_ms(200);
  EXPECT_TRUE(client.raw.empty());
  client.send_hex("fafb03000000");
  client.send_hex("fafb03020002");
  client.run_ms(200);
  EXPECT_EQ(client.packets.size(), 1u);
  EXPECT_EQ(client.robot.truth().session, Session::Synced0);
}

TEST(P3AtSession, RepeatsALostEcho) {
  VirtualClient client(exact_settings());
  for (const char* hex : {"fafb03000000", "fafb03010001", "fafb03010001", "fafb03000000", "fafb03010001"}) {
    client.send_hex(hex);
    client.run_ms(60);
  }
  EXPECT_EQ(client.packets.size(), 5u);
  EXPECT_EQ(client.robot.truth().session, Session::Synced1);
}

TEST(P3AtSession, SendsNoSipBeforeOpenAndOneEvery100MsAfter) {
  VirtualClient client(exact_settings());
  client.sync();
  client.run_ms(500);
  EXPECT_TRUE(client.sips().empty());
  client.command(CommandId::Open, 1);
  client.run_ms(1100);
  const std::vector<Received> sips = client.sips();
  ASSERT_GE(sips.size(), 9u);
  // Packets end a little earlier or later with the number of sonar readings; 9600 baud is 1.04 ms a byte.
  for (std::size_t i = 1; i < sips.size(); ++i) {
    EXPECT_NEAR(seconds_from_ns(sips[i].t_ns - sips[i - 1].t_ns), 0.1, 0.0085);
  }
}

/// Packets that open and close the session, in hexadecimal, and the clients that send them.
struct OpenAndCloseCase {
  const char* name;
  const char* open;
  const char* close;
};
void PrintTo(const OpenAndCloseCase& tested, std::ostream* out) {
  *out << tested.open << " " << tested.close;
}
class P3AtOpenAndClose : public testing::TestWithParam<OpenAndCloseCase> {};

TEST_P(P3AtOpenAndClose, WorkWithThisSpelling) {
  VirtualClient client(exact_settings());
  client.sync();
  client.send_hex(GetParam().open);
  client.run_ms(300);
  EXPECT_FALSE(client.sips().empty());
  client.command(CommandId::Enable, 1);
  client.command(CommandId::Vel, 300);
  client.run_ms(1000);
  client.send_hex(GetParam().close);
  client.run_ms(100);
  EXPECT_EQ(client.robot.truth().session, Session::Waiting);
  EXPECT_FALSE(client.robot.truth().motors_enabled);
  client.forget();
  client.run_ms(1000);
  EXPECT_TRUE(client.raw.empty()) << "SIPs went on after CLOSE";
  EXPECT_EQ(client.robot.truth().v_m_s, 0.0);
  ASSERT_NO_FATAL_FAILURE(client.sync());
}

INSTANTIATE_TEST_SUITE_P(
    Spellings, P3AtOpenAndClose,
    testing::Values(OpenAndCloseCase{"P2osAndSoarWithoutArgument", "fafb03010001", "fafb03020002"},
                    OpenAndCloseCase{"AriaWithTheInteger1", "fafb06013b0100023b", "fafb06023b0100033b"},
                    OpenAndCloseCase{"ATypeByteWithoutArgument", "fafb04013b013b", "fafb04023b023b"}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST(P3AtSession, IdsOfTheSyncsMeanPulseOpenAndCloseOnceConnected) {
  VirtualClient client(exact_settings());
  client.open();
  client.forget();
  client.send_hex("fafb03000000");
  client.send_hex("fafb03010001");
  client.run_ms(250);
  EXPECT_TRUE(client.of_id(0).empty()) << "PULSE was echoed";
  EXPECT_TRUE(client.of_id(1).empty()) << "OPEN was echoed";
  EXPECT_EQ(client.robot.truth().session, Session::Open);
  client.send_hex("fafb03020002");
  client.run_ms(50);
  EXPECT_EQ(client.robot.truth().session, Session::Waiting);
}

TEST(P3AtSession, LeftOpenItAnswersASyncWithSipsAndClosesOnRequest) {
  P3AtSettings settings = exact_settings();
  settings.faults.push_back({.kind = FaultKind::LeftOpen, .t_ns = 0, .duration_ns = 0, .amount = 0.0});
  VirtualClient client(settings);
  client.run_ms(10);
  client.send_hex("fafb03000000");
  client.run_ms(250);
  EXPECT_TRUE(client.of_id(0).empty());
  EXPECT_GE(client.sips().size(), 2u);
  client.command(CommandId::Close);
  client.run_ms(150);
  client.forget();
  ASSERT_NO_FATAL_FAILURE(client.sync());
}

TEST(P3AtSession, AHangUpForgetsAHandshakeButNotAnOpenSession) {
  VirtualClient client(exact_settings());
  client.sync();
  client.robot.line_dropped();
  ASSERT_NO_FATAL_FAILURE(client.sync());
  client.command(CommandId::Open);
  client.run_ms(50);
  client.robot.line_dropped();
  EXPECT_EQ(client.robot.truth().session, Session::Open);
}

TEST(P3AtSession, WhatIsOnTheWireWhenTheClientHangsUpStillArrives) {
  for (int ms = 0; ms < 10; ++ms) {  // CLOSE takes 6 ms at 9600 baud
    VirtualClient client(exact_settings());
    client.open();
    client.command(CommandId::Close);
    client.run_ms(ms);
    client.robot.line_dropped();
    client.run_ms(30);
    EXPECT_EQ(client.robot.truth().session, Session::Waiting) << "hung up after " << ms << " ms";
  }
}

TEST(P3AtSession, SurvivesGarbageAndUnknownCommands) {
  VirtualClient client(exact_settings());
  client.send_hex("00fffafbfafb03000001fafb");  // noise, a wrong checksum, a lone header
  client.run_ms(400);
  ASSERT_NO_FATAL_FAILURE(client.open());
  for (const char* hex : {"fafb03c800c8", "fafb06c93b0500ce3b", "fafb062a9907003199"}) client.send_hex(hex);
  client.run_ms(300);
  EXPECT_EQ(client.robot.truth().session, Session::Open);
}

TEST(P3AtSession, ResetSendsTheNoticeAndLosesTheState) {
  for (const int notice : {0xFE, 0xFF}) {
    VirtualClient client(exact_settings());
    client.open_and_enable();
    client.command(CommandId::Vel, 300);
    client.run_ms(1500);
    client.forget();
    client.robot.reset(static_cast<std::uint8_t>(notice));
    client.run_ms(1000);
    EXPECT_EQ(client.of_id(static_cast<std::uint8_t>(notice)).size(), 1u);
    EXPECT_LE(client.sips().size(), 1u) << "more than the one under way";
    const RobotTruth truth = client.robot.truth();
    EXPECT_EQ(truth.session, Session::Waiting);
    EXPECT_LT(truth.odometry.x_m, 0.05) << "only the way to rest is counted";
    EXPECT_GT(truth.pose.x_m, 0.2);
    client.forget();
    client.open_and_enable();
    client.run_fed_ms(1000);
    EXPECT_EQ(client.robot.truth().v_m_s, 0.0) << "the old setpoint survived the reset";
  }
}

}  // namespace
}  // namespace heel::sim
