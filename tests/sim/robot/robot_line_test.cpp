// The serial line: bytes take their time, wrong rates make garbage, and the robot's rate can be changed.
#include <algorithm>

#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using test::exact_settings;
using test::from_hex;
using test::Received;
using test::VirtualClient;

using arcos::CommandId;
constexpr int kRates[] = {9600, 19200, 38400, 57600, 115200};

std::vector<std::uint8_t> all_bytes() {
  std::vector<std::uint8_t> bytes(256);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
  return bytes;
}

TEST(UartLine, DeliversEveryByteAfterTenBitTimesAtEveryRate) {
  for (const int baud : kRates) {
    UartLine line(baud);
    line.send(all_bytes(), 0);
    std::vector<std::uint8_t> out;
    const TimeNs byte_ns = 10 * kNsPerS / baud;
    line.receive_until(byte_ns * 9 / 10, out);
    EXPECT_TRUE(out.empty());
    line.receive_until(byte_ns * 100, out);
    EXPECT_EQ(out.size(), 100u);
    line.receive_until(byte_ns * 257, out);
    EXPECT_EQ(out, all_bytes());
    EXPECT_LE(line.backlog(), 1u);
  }
}

TEST(UartLine, ReadsWholeBytesWhateverTheGapsBetweenThem) {
  UartLine line(9600);
  std::vector<std::uint8_t> out;
  TimeNs t_ns = 12345;
  for (const std::uint8_t byte : all_bytes()) {
    line.send(std::span(&byte, 1), t_ns);
    t_ns += 1041667 + 77777 * (byte % 7);
    line.receive_until(t_ns, out);
  }
  EXPECT_EQ(out, all_bytes());
}

TEST(UartLine, AtAnotherRateNothingIsReadAsItWasSent) {
  for (const int sender : kRates) {
    for (const int receiver : kRates) {
      if (sender == receiver) continue;
      UartLine line(sender);
      line.set_receiver_baud(receiver);
      const std::vector<std::uint8_t> sync = from_hex("fafb03000000");
      line.send(sync, 0);
      std::vector<std::uint8_t> out;
      line.receive_until(kNsPerS, out);
      EXPECT_FALSE(out.empty()) << sender << " read at " << receiver;
      EXPECT_EQ(std::search(out.begin(), out.end(), sync.begin(), sync.end()), out.end())
          << sender << " read at " << receiver;
    }
  }
}

TEST(UartLine, ASlowerReceiverSeesFewerBytesAFasterOneMore) {
  std::vector<std::uint8_t> slow_out, fast_out;
  const std::vector<std::uint8_t> zeros(50, 0);
  UartLine fast_to_slow(38400);
  fast_to_slow.set_receiver_baud(9600);
  fast_to_slow.send(zeros, 0);
  fast_to_slow.receive_until(kNsPerS, slow_out);
  UartLine slow_to_fast(9600);
  slow_to_fast.set_receiver_baud(38400);
  slow_to_fast.send(zeros, 0);
  slow_to_fast.receive_until(kNsPerS, fast_out);
  EXPECT_LT(slow_out.size(), 20u);
  EXPECT_GE(fast_out.size(), 50u);
}

TEST(RobotLinePacing, AConfigPacAt9600TakesItsLineTime) {
  for (const int baud : {9600, 38400}) {
    P3AtSettings settings = exact_settings();
    settings.boot_baud = baud;
    VirtualClient client(settings);
    client.sync();
    client.command(CommandId::Config, 1);
    const TimeNs t_sent_ns = client.t_ns;
    client.run_ms(400);
    ASSERT_EQ(client.of_id(0x20).size(), 1u);
    const Received answer = client.of_id(0x20)[0];
    const double line_s = (9.0 + static_cast<double>(answer.body.size()) + 5.0) * 10.0 / baud;
    EXPECT_NEAR(seconds_from_ns(answer.t_ns - t_sent_ns), line_s, 0.0035);
  }
}

TEST(RobotLinePacing, CommandsArriveOneAfterTheOther) {
  VirtualClient client(exact_settings());
  client.open();
  for (int i = 0; i < 20; ++i) client.command(CommandId::Pulse);
  client.command(CommandId::Enable, 1);
  client.run_ms(20 * 6250 / 1000);
  EXPECT_FALSE(client.robot.truth().motors_enabled);
  EXPECT_GT(client.robot.input_backlog(), 0u);
  client.run_ms(12);
  EXPECT_TRUE(client.robot.truth().motors_enabled);
}

TEST(RobotLinePacing, AFullLineLosesCyclesNotBytes) {
  VirtualClient client(exact_settings());
  client.open();
  client.command(CommandId::Encoder, 2);
  client.command(CommandId::IoRequest, 2);
  client.command(CommandId::JoyRequest, 2);
  client.run_fed_ms(5000);
  const std::size_t sips = client.sips().size();
  EXPECT_GT(sips, 20u);
  EXPECT_LT(sips, 50u) << "more than 9600 baud can carry";
  arcos::Parser parser;
  parser.feed(client.raw, 0, [](const arcos::Packet&) {});
  EXPECT_EQ(parser.counters().checksum_errors, 0u);
}

TEST(RobotLineBaud, OnlyTheRightRateGetsAnEcho) {
  for (const int robot_baud : kRates) {
    for (const int host_baud : kRates) {
      P3AtSettings settings = exact_settings();
      settings.boot_baud = robot_baud;
      VirtualClient client(settings);
      client.robot.set_host_baud(host_baud);
      client.send_hex("fafb03000000");
      client.run_ms(150);
      EXPECT_EQ(client.of_id(0).size(), robot_baud == host_baud ? 1u : 0u);
    }
  }
}

TEST(RobotLineBaud, ASweepFindsARobotLeftAtAnotherRateAfterGarbage) {
  P3AtSettings settings = exact_settings();
  settings.boot_baud = 57600;
  VirtualClient client(settings);
  int found = 0;
  for (const int baud : kRates) {
    client.robot.set_host_baud(baud);
    client.send_hex("fafb03000000");
    client.run_ms(400);
    if (!client.of_id(0).empty() && found == 0) found = baud;
  }
  EXPECT_EQ(found, 57600);
}

class RobotLineAfterClose : public testing::TestWithParam<bool> {};

TEST_P(RobotLineAfterClose, HostBaudAsTheAriaClientDoesIt) {
  const bool keeps_rate = GetParam();
  P3AtSettings settings = exact_settings();
  settings.keeps_rate_after_close = keeps_rate;
  VirtualClient client(settings);
  client.robot.set_host_baud(9600);
  client.open();
  client.send_hex("fafb06323b0200343b");  // HOSTBAUD 2
  client.run_ms(10);
  client.robot.set_host_baud(38400);
  client.run_ms(10);
  client.forget();
  client.command(CommandId::Pulse);
  client.run_ms(900);
  EXPECT_GE(client.sips().size(), 8u);
  EXPECT_EQ(client.robot.baud(), 38400);
  EXPECT_EQ(client.robot.truth().session, Session::Open);
  client.command(CommandId::Close);
  client.run_ms(100);
  EXPECT_EQ(client.robot.baud(), keeps_rate ? 38400 : 9600);
  client.robot.set_host_baud(9600);
  client.forget();
  client.send_hex("fafb03000000");
  client.run_ms(200);
  EXPECT_EQ(client.of_id(0).empty(), keeps_rate);
}

INSTANTIATE_TEST_SUITE_P(Rates, RobotLineAfterClose, testing::Bool(),
                         [](const auto& kept) { return kept.param ? "Stays" : "FallsBack"; });

TEST(RobotLineBaud, HostBaudIsIgnoredWhenItCannotBeChanged) {
  P3AtSettings settings = exact_settings();
  settings.autobaud = 0;
  VirtualClient client(settings);
  client.open();
  client.command(CommandId::HostBaud, 2);
  client.run_ms(100);
  EXPECT_EQ(client.robot.baud(), 9600);
}

TEST(RobotLineBaud, AnImpossibleCodeIsIgnored) {
  VirtualClient client(exact_settings());
  client.open();
  client.command(CommandId::HostBaud, 5);
  client.run_ms(100);
  EXPECT_EQ(client.robot.baud(), 9600);
}

}  // namespace
}  // namespace heel::sim
