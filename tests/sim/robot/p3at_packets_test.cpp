// CONFIGpac, ENCODER, IO and joystick packets.
#include "arcos/other_packets.h"
#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using test::exact_settings;
using test::Received;
using test::VirtualClient;

using arcos::CommandId;

TEST(P3AtConfigPac, HoldsTheSettingsThatHoldAfterBoot) {
  VirtualClient client(exact_settings());
  client.open();
  client.send_hex("fafb06123b0100133b");
  client.run_ms(400);
  const std::vector<Received> answers = client.of_id(0x20);
  ASSERT_EQ(answers.size(), 1u);
  arcos::ConfigPacket config;
  ASSERT_EQ(arcos::decode_config(answers[0].body, config), arcos::DecodeResult::Ok);
  EXPECT_EQ(config.type.view(), "Pioneer");
  EXPECT_EQ(config.subtype.view(), "p3at-sh");
  EXPECT_EQ(config.name.view(), "heel-sim");
  EXPECT_EQ(config.four_motors, 1);
  EXPECT_EQ(config.trans_vel_top, 1200);
  EXPECT_EQ(config.trans_vel_max, 750);
  EXPECT_EQ(config.rot_vel_max, 100);
  EXPECT_EQ(config.trans_acc, 300);
  EXPECT_EQ(config.trans_decel, 300);
  EXPECT_EQ(config.rot_acc, 100);
  EXPECT_EQ(config.watchdog_ms, 2000);
  EXPECT_EQ(config.sip_cycle_ms, 100);
  EXPECT_EQ(config.sonar_cycle_ms, 40);
  EXPECT_EQ(config.host_baud, 0);
  EXPECT_EQ(config.autobaud, 2);
  EXPECT_EQ(config.ticks_mm, 138);
  EXPECT_EQ(config.kinematics_delay, 0);
}

TEST(P3AtConfigPac, AnswersWithAndWithoutArgumentAndBeforeOpenToo) {
  for (const char* hex : {"fafb03120012", "fafb06123b0100133b"}) {
    VirtualClient client(exact_settings());
    client.sync();
    client.send_hex(hex);
    client.run_ms(300);
    EXPECT_EQ(client.of_id(0x20).size(), 1u) << hex;
  }
}

TEST(P3AtConfigPac, ShowsTheConstantsThatWereSet) {
  VirtualClient client(exact_settings());
  client.open();
  client.command(CommandId::TicksMm, 100);
  client.command(CommandId::RotKp, 41);
  client.command(CommandId::TransKi, 7);
  client.command(CommandId::DriftFactor, -12);
  client.command(CommandId::Config);
  client.run_ms(500);
  ASSERT_EQ(client.of_id(0x20).size(), 1u);
  arcos::ConfigPacket config;
  ASSERT_EQ(arcos::decode_config(client.of_id(0x20)[0].body, config), arcos::DecodeResult::Ok);
  EXPECT_EQ(config.ticks_mm, 100);
  EXPECT_EQ(config.rot_kp, 41);
  EXPECT_EQ(config.trans_ki, 7);
  EXPECT_EQ(config.drift_factor, -12);
}

TEST(P3AtConfigPac, NeverPassesItsChecksumUnderTheFault) {
  P3AtSettings settings = exact_settings();
  settings.faults.push_back({.kind = FaultKind::BadConfig, .t_ns = 0, .duration_ns = 0, .amount = 0.0});
  VirtualClient client(settings);
  client.open();
  for (int i = 0; i < 5; ++i) {
    client.command(CommandId::Config, 1);
    client.run_ms(500);
  }
  EXPECT_TRUE(client.of_id(0x20).empty());
  const std::string bytes(client.raw.begin(), client.raw.end());
  EXPECT_NE(bytes.find("SIM-0001"), std::string::npos) << "it is sent all the same";
  EXPECT_GT(client.sips().size(), 15u);
}

TEST(P3AtEncoder, ComesOnceOrWithEverySipUntilStopped) {
  VirtualClient client(exact_settings());
  client.open_and_enable();
  client.command(CommandId::Encoder, 1);
  client.run_ms(500);
  EXPECT_EQ(client.of_id(0x90).size(), 1u);
  client.command(CommandId::Encoder, 2);
  client.command(CommandId::Vel, 300);
  client.run_fed_ms(3000);
  const std::vector<Received> stream = client.of_id(0x90);
  EXPECT_NEAR(static_cast<double>(stream.size()), 31.0, 2.0);
  arcos::EncoderPacket encoder;
  ASSERT_EQ(arcos::decode_encoder(stream.back().body, encoder), arcos::DecodeResult::Ok);
  EXPECT_EQ(encoder.left_ticks, encoder.right_ticks);
  const double travelled_mm = client.robot.truth().odometry.x_m * 1000.0;
  EXPECT_NEAR(encoder.left_ticks / 138.0, travelled_mm, 50.0);
  EXPECT_GT(travelled_mm, 500.0);
  client.command(CommandId::Encoder, 0);
  client.run_ms(200);
  client.forget();
  client.run_ms(500);
  EXPECT_TRUE(client.of_id(0x90).empty());
}

TEST(P3AtIo, TellsTheDigitalOutputs) {
  VirtualClient client(exact_settings());
  client.open();
  client.send(arcos::encode_digout(0xFF, 0x81));
  client.command(CommandId::IoRequest, 1);
  client.run_ms(400);
  ASSERT_EQ(client.of_id(0xF0).size(), 1u);
  arcos::IoPacket io;
  ASSERT_EQ(arcos::decode_io(client.of_id(0xF0)[0].body, io), arcos::DecodeResult::Ok);
  ASSERT_GE(io.output_count, 1);
  EXPECT_EQ(io.outputs[0], 0x81);
}

TEST(P3AtJoystick, AnswersARequest) {
  VirtualClient client(exact_settings());
  client.open();
  client.command(CommandId::JoyRequest, 1);
  client.run_ms(400);
  ASSERT_EQ(client.of_id(0xF8).size(), 1u);
  EXPECT_EQ(client.of_id(0xF8)[0].body.size(), 9u);
}

TEST(P3AtMaintenance, LeavesItDeafUntilReset) {
  VirtualClient client(exact_settings());
  client.open();
  client.send_hex("fafb03ff00ff");
  client.run_ms(200);
  client.forget();
  client.send_hex("fafb03000000");
  client.run_ms(500);
  EXPECT_TRUE(client.raw.empty());
  client.robot.reset();
  client.run_ms(50);
  ASSERT_NO_FATAL_FAILURE(client.sync());
}

TEST(P3AtResetCommand, IsObeyed) {
  VirtualClient client(exact_settings());
  client.open();
  client.send_hex("fafb03fd00fd");
  client.run_ms(200);
  EXPECT_EQ(client.of_id(0xFE).size(), 1u);
  EXPECT_EQ(client.robot.truth().session, Session::Waiting);
}

}  // namespace
}  // namespace heel::sim
