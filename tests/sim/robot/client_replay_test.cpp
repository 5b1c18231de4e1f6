// Sessions as clients written elsewhere hold them, byte for byte and with their timing: an ARIA client, the
// ROS p2os driver, a plain Python client. The bytes are literals, so that no encoder of ours stands on both
// sides.
#include <numbers>

#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using test::exact_settings;
using test::from_hex;
using test::Received;
using test::VirtualClient;

/// What these clients do with a sync step: send, wait for a packet with that id, send again if none comes.
bool sync_step(VirtualClient& client, const std::string& hex, int wait_ms) {
  const std::uint8_t id = from_hex(hex)[3];
  const std::size_t before = client.of_id(id).size();
  client.send_hex(hex);
  for (int ms = 0; ms < wait_ms; ms += 10) {
    client.run_ms(10);
    if (client.of_id(id).size() > before) return true;
  }
  return false;
}

/// The vendor's client: at 9600, HOSTBAUD 38400, confirmed by a packet; CLOSE, and its own port back at once.
bool connect_raise_and_leave(VirtualClient& client) {
  const bool synced = sync_step(client, "fafb03000000", 1070) && sync_step(client, "fafb03010001", 1070) &&
                      sync_step(client, "fafb03020002", 1070);
  if (!synced) return false;
  client.send_hex("fafb06013b0100023b");  // OPEN 1
  client.run_ms(150);
  client.send_hex("fafb06323b0200343b");  // HOSTBAUD 2
  client.run_ms(30);
  client.robot.set_host_baud(38400);
  client.run_ms(10);
  client.forget();
  client.send_hex("fafb03000000");  // PULSE
  client.run_ms(900);
  const bool confirmed = !client.sips().empty();
  client.send_hex("fafb06023b0100033b");  // CLOSE 1
  client.run_ms(10);
  client.robot.set_host_baud(9600);
  client.run_ms(100);
  client.forget();
  return confirmed;
}

TEST(AriaClient, ConnectsAgainAndAgainToAPortThatFallsBackAndOnceToOneThatStays) {
  VirtualClient falls_back(exact_settings());
  falls_back.robot.set_host_baud(9600);
  for (int time = 0; time < 4; ++time) ASSERT_TRUE(connect_raise_and_leave(falls_back)) << time;

  P3AtSettings settings = exact_settings();
  settings.keeps_rate_after_close = true;
  VirtualClient stays(settings);
  stays.robot.set_host_baud(9600);
  EXPECT_TRUE(connect_raise_and_leave(stays));
  EXPECT_FALSE(connect_raise_and_leave(stays));
}

void expect_sips_every_cycle(const VirtualClient& client, TimeNs from_ns) {
  TimeNs last_ns = from_ns;
  for (const Received& sip : client.sips()) {
    if (sip.t_ns < from_ns) continue;
    EXPECT_LT(sip.t_ns - last_ns, 350 * kNsPerMs) << "a gap before " << seconds_from_ns(sip.t_ns) << " s";
    last_ns = sip.t_ns;
  }
  EXPECT_LT(client.t_ns - last_ns, 350 * kNsPerMs);
}

TEST(AriaClient, ConnectsDrivesAndLeaves) {
  VirtualClient client(exact_settings());
  ASSERT_TRUE(sync_step(client, "fafb03000000", 1070));
  ASSERT_TRUE(sync_step(client, "fafb03010001", 1070));
  ASSERT_TRUE(sync_step(client, "fafb03020002", 1070));
  client.run_ms(90);
  client.send_hex("fafb06013b0100023b");  // OPEN 1
  client.run_ms(10);
  client.send_hex("fafb06123b0100133b");  // CONFIG 1
  client.run_ms(500);
  ASSERT_EQ(client.of_id(0x20).size(), 1u);
  ASSERT_FALSE(client.sips().empty());
  // The limits of CONFIGpac come back as SETV 750, SETA ±300, SETRV 100, SETRA ±100, 5 ms apart.
  for (const char* hex : {"fafb06063bee02f43d", "fafb06053b2c01313c", "fafb06051b2c01311c",
                          "fafb060a3b64006e3b", "fafb06173b64007b3b", "fafb06171b64007b1b"}) {
    client.send_hex(hex);
    client.run_ms(5);
  }
  client.send_hex("fafb063e3b01003f3b");  // battery info
  client.send_hex("fafb03000000");        // PULSE
  client.run_ms(200);
  const TimeNs t_ready_ns = client.t_ns;
  client.send_hex("fafb06043b0100053b");    // ENABLE 1
  for (int i = 0; i < 10; ++i) {            // motion repeated about every 500 ms
    client.send_hex("fafb060b3bc800d33b");  // VEL 200
    client.run_ms(500);
  }
  EXPECT_NEAR(client.robot.truth().v_m_s, 0.2, 1e-9);
  EXPECT_FALSE(client.happened(RobotEventKind::WatchdogStop));
  expect_sips_every_cycle(client, t_ready_ns);
  client.send_hex("fafb06043b0000043b");  // ENABLE 0
  client.send_hex("fafb06023b0100033b");  // CLOSE 1
  client.run_ms(500);
  EXPECT_EQ(client.robot.truth().session, Session::Waiting);
  EXPECT_EQ(client.robot.truth().v_m_s, 0.0);
}

TEST(AriaClient, ClosesARobotLeftOpenWhenItSeesASip) {
  P3AtSettings settings = exact_settings();
  settings.faults.push_back({.kind = FaultKind::LeftOpen, .t_ns = 0, .duration_ns = 0, .amount = 0.0});
  VirtualClient client(settings);
  EXPECT_FALSE(sync_step(client, "fafb03000000", 1070));
  ASSERT_FALSE(client.sips().empty());
  client.send_hex("fafb06023b0100033b");
  client.run_ms(300);
  ASSERT_TRUE(sync_step(client, "fafb03000000", 1070));
}

TEST(P2osClient, SweepsTheRatesAndFindsItsRobot) {
  P3AtSettings settings = exact_settings();
  settings.boot_baud = 38400;
  VirtualClient client(settings);
  bool synced = false;
  for (const int baud : {9600, 19200, 38400}) {
    client.robot.set_host_baud(baud);
    for (int attempt = 0; attempt < 3 && !synced; ++attempt) synced = sync_step(client, "fafb03000000", 300);
    EXPECT_EQ(synced, baud == 38400);
  }
  EXPECT_TRUE(sync_step(client, "fafb03010001", 300));
  EXPECT_TRUE(sync_step(client, "fafb03020002", 300));
}

TEST(P2osClient, ItsOpeningChatterIsUnderstoodAndItsSlowRepeatsTripTheWatchdog) {
  VirtualClient client(exact_settings());
  ASSERT_TRUE(sync_step(client, "fafb03000000", 300));
  ASSERT_TRUE(sync_step(client, "fafb03010001", 300));
  ASSERT_TRUE(sync_step(client, "fafb03020002", 300));
  client.send_hex("fafb03010001");  // OPEN without argument
  client.run_ms(50);
  client.send_hex("fafb03000000");  // PULSE
  client.run_ms(50);
  client.send_hex("fafb061c3b00001c3b");      // SONAR 0
  client.send_hex("fafb06053bf401f93c");      // SETA 500
  client.send_hex("fafb06051bf401f91c");      // SETA −500
  client.send_hex("fafb061c3b01001d3b");      // SONAR 1
  client.send_hex("fafb082a2b030102032f2f");  // TTY2 with three bytes
  client.send_hex("fafb062b3b0c00373b");      // GETAUX 12
  client.send_hex("fafb04073b073b");          // SETO, a lone 3B
  client.send_hex("fafb06043b0100053b");      // ENABLE 1
  client.run_ms(300);
  EXPECT_TRUE(client.robot.truth().motors_enabled);
  EXPECT_EQ(client.last_sip().flags & arcos::kFlagSonarArrays, 0b110);

  client.send_hex("fafb060b3bfa00053b");  // VEL 250, unchanged, again only after 2.04 s
  client.run_ms(2040);
  EXPECT_NEAR(client.robot.truth().v_m_s, 0.25, 0.05);
  EXPECT_TRUE(client.robot.truth().watchdog_stopped) << "2.04 s is longer than the watchdog";
  client.send_hex("fafb060b3bfa00053b");
  client.run_ms(300);
  EXPECT_NEAR(client.robot.truth().v_m_s, 0.25, 1e-9);
  client.send_hex("fafb031d001d");  // STOP
  client.run_ms(2);
  client.send_hex("fafb03020002");  // CLOSE without argument
  client.run_ms(800);
  EXPECT_EQ(client.robot.truth().session, Session::Waiting);
  EXPECT_EQ(client.robot.truth().v_m_s, 0.0);
}

TEST(PythonClient, SendsAllThreeSyncsWithoutWaitingAndPulsesEverySecond) {
  VirtualClient client(exact_settings());
  for (const char* hex : {"fafb03000000", "fafb03010001", "fafb03020002"}) client.send_hex(hex);
  client.run_ms(200);
  EXPECT_EQ(client.packets.size(), 3u);
  client.send_hex("fafb06013b0100023b");
  client.send_hex("fafb06043b0100053b");
  client.send_hex("fafb06153b0a001f3b");  // RVEL +10 deg/s
  for (int i = 0; i < 9; ++i) {
    client.run_ms(1000);
    client.send_hex("fafb03000000");
  }
  EXPECT_FALSE(client.happened(RobotEventKind::WatchdogStop));
  // 10 deg/s reached after 0.1 s, since some 30 ms after the start: about 89 degrees.
  EXPECT_NEAR(client.robot.true_pose().heading_rad * 180.0 / std::numbers::pi, 89.1, 0.6);
  const arcos::Sip sip = client.last_sip();
  EXPECT_NEAR(sip.th_pos * 360.0 / 4096.0, client.robot.true_pose().heading_rad * 180.0 / std::numbers::pi,
              1.5);
}

}  // namespace
}  // namespace heel::sim
