// heel-sim over a pty and a TCP port, with a client that shares no code with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "loopback/heel-sim/raw_client.h"
#include "loopback/heel-sim/running_sim.h"
#include "support/process.h"
#include "support/temporary_folder.h"
#include "support/text.h"

namespace heel {
namespace {

using test::Bytes;
using test::eventually;
using test::i16_at;
using test::is_moving_sip;
using test::is_sip;
using test::kClose;
using test::kConfig;
using test::kEnable;
using test::kOpen;
using test::kVel;
using test::monotonic_s;
using test::motors_on;
using test::occurrences;
using test::RawClient;
using test::RunningSim;
using test::sleep_s;
using test::TemporaryFolder;

/// Both kinds of line, by name.
class HeelSim : public testing::TestWithParam<const char*> {
 protected:
  std::string robot() const {
    return std::string(GetParam()) == "pty" ? "pty:" + folder.file("robot") : "tcp:0";
  }
  TemporaryFolder folder;
};
INSTANTIATE_TEST_SUITE_P(Lines, HeelSim, testing::Values("pty", "tcp"),
                         [](const auto& line) { return std::string(line.param); });

TEST_P(HeelSim, SyncsOpensMovesStopsByWatchdogResumesAndCloses) {
  RunningSim sim(robot());
  RawClient client = RawClient::at(sim.address);
  ASSERT_TRUE(client.sync()) << sim.process.output();
  const std::string echo(client.packets.back().begin() + 1, client.packets.back().end());
  EXPECT_NE(echo.find(std::string("Pioneer\0p3at-sh", 15)), std::string::npos);

  client.listen(0.3);
  EXPECT_TRUE(std::none_of(client.packets.begin(), client.packets.end(), is_sip)) << "SIPs before OPEN";
  client.send(kOpen, 1);
  const Bytes first_sip = client.next_sip();
  ASSERT_FALSE(first_sip.empty());
  EXPECT_FALSE(motors_on(first_sip));
  client.send(kEnable, 1);
  client.send(kVel, 200);
  const auto moves_at_200 = [](const Bytes& body) { return is_moving_sip(body) && i16_at(body, 7) == 200; };
  const Bytes moving =
      client.wait_for([&](const Bytes& body) { return moves_at_200(body) && i16_at(body, 1) > 100; });
  ASSERT_FALSE(moving.empty()) << "XPOS stays below 100 mm";
  EXPECT_TRUE(motors_on(moving));

  EXPECT_TRUE(sim.process.says("watchdog stop"));
  EXPECT_FALSE(client.wait_for([](const Bytes& body) { return body.at(0) == 0x32; }).empty());
  client.send(0);  // PULSE
  EXPECT_FALSE(client.wait_for(moves_at_200).empty()) << "the old motion does not resume";

  client.send(kClose);
  EXPECT_TRUE(sim.process.says("closed"));
  EXPECT_TRUE(client.falls_silent());
  for (const char* event : {"client connected", "synced", "opened", "enabled", "watchdog over"}) {
    EXPECT_NE(sim.process.output().find(event), std::string::npos) << event;
  }
}

TEST_P(HeelSim, AfterAClientLeavesTheNextOneFindsTheRobotOpen) {
  RunningSim sim(robot());
  {
    RawClient first = RawClient::at(sim.address);
    ASSERT_TRUE(first.sync());
    first.send(kOpen);
    ASSERT_FALSE(first.next_sip().empty());
  }
  ASSERT_TRUE(sim.process.says("client gone"));
  RawClient second = RawClient::at(sim.address);
  ASSERT_FALSE(second.next_sip().empty());
  second.send(kClose);
  EXPECT_TRUE(second.falls_silent());
  EXPECT_TRUE(second.sync());
}

TEST_P(HeelSim, AClientDoesNotReceiveBytesSentBeforeItConnected) {
  RunningSim sim(robot());
  {
    RawClient first = RawClient::at(sim.address);
    ASSERT_TRUE(first.sync());
    first.send(kOpen);
    ASSERT_FALSE(first.next_sip().empty());
  }
  // The line carries 960 bytes a second. A busy machine may deliver some of them late to one client, but not
  // to every client.
  std::size_t fewest = 1000;
  for (int i = 0; i < 10 && fewest > 400; ++i) {
    sleep_s(1.5);
    RawClient client = RawClient::at(sim.address);
    client.listen(0.06);
    fewest = std::min(fewest, client.raw.size());
  }
  EXPECT_LE(fewest, 400u);
}

TEST_P(HeelSim, AnUnfinishedHandshakeIsDiscardedWhenItsClientLeaves) {
  RunningSim sim(robot());
  for (int i = 0; i < 3; ++i) {
    RawClient client = RawClient::at(sim.address);
    EXPECT_TRUE(client.sync()) << "client " << i;
    client.hang_up();
    EXPECT_TRUE(eventually([&] { return occurrences(sim.process.output(), "client gone") > i; }));
  }
}

TEST_P(HeelSim, PacketsTakeTheTransmissionTimeOfTheLine) {
  RunningSim sim(robot());
  RawClient client = RawClient::at(sim.address);
  ASSERT_TRUE(client.sync());
  double longest_wait_s = 1.0;  // beyond the transmission time; a busy machine may delay some attempts
  for (int i = 0; i < 10 && longest_wait_s > 0.1; ++i) {
    const double start_s = monotonic_s();
    client.send(kConfig, 1);
    const Bytes config = client.wait_for([](const Bytes& body) { return body.at(0) == 0x20; });
    ASSERT_FALSE(config.empty());
    const double line_s = (9.0 + static_cast<double>(config.size()) + 5.0) / 960.0;
    const double elapsed_s = monotonic_s() - start_s;
    EXPECT_GT(elapsed_s, line_s - 0.005);
    longest_wait_s = std::min(longest_wait_s, elapsed_s - line_s);
  }
  EXPECT_LE(longest_wait_s, 0.1);
}

TEST_P(HeelSim, FaultsOfTheCommandLineHappen) {
  RunningSim sim(robot(), {"--fault", "left_open@0", "--fault", "bumper@0.2=4"});
  ASSERT_TRUE(sim.process.says("fault bumper"));
  RawClient client = RawClient::at(sim.address);
  const auto bumped = [](const Bytes& body) { return is_sip(body) && body.at(13) == 4 << 1; };
  EXPECT_FALSE(client.wait_for(bumped).empty()) << "no front bumper in the high byte";
}

TEST_P(HeelSim, TruthHasARowEvery20Ms) {
  const std::string path = folder.file("truth.csv");
  RunningSim sim(robot(), {"--truth", path, "--duration", "5", "--exact", "--fault", "left_open@0=300"});
  ASSERT_NE(sim.address, "");
  {
    const RawClient client = RawClient::at(sim.address);
    client.send(0);  // PULSE: the robot drives
    EXPECT_EQ(sim.process.wait(), 0);
  }
  std::istringstream lines(test::read_text(path));
  std::string line;
  std::getline(lines, line);
  std::map<std::string, std::size_t> column;
  std::istringstream header(line);
  for (std::string name; std::getline(header, name, ',');) column.emplace(name, column.size());
  ASSERT_TRUE(column.contains("t_s") && column.contains("robot_x_m") && column.contains("odom_x_m") &&
              column.contains("motors_enabled") && column.contains("watchdog_stopped"));
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
    ASSERT_EQ(rows.back().size(), column.size());
    EXPECT_NEAR(rows.back()[column["t_s"]], 0.02 * static_cast<double>(rows.size() - 1), 1e-6);
  }
  EXPECT_GE(rows.size(), 250u);
  EXPECT_GT(rows.back()[column["robot_x_m"]], 0.1);
  EXPECT_EQ(rows.back()[column["robot_x_m"]], rows.back()[column["odom_x_m"]]);
}

}  // namespace
}  // namespace heel
