// heel-sim over a pty and a TCP port, with a client that shares no code with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "loopback/heel-sim/raw_client.h"
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
using test::monotonic_s;
using test::occurrences;
using test::Process;
using test::RawClient;
using test::sleep_s;
using test::TemporaryFolder;

constexpr int kOpen = 1, kClose = 2, kEnable = 4, kVel = 11, kConfig = 18, kHostBaud = 50;

bool motors_on(const Bytes& sip) {
  return (sip.at(16) & 1) != 0;
}

/// A running heel-sim; `address` is what it announced.
struct Sim {
  Sim(const std::string& robot, std::vector<std::string> options = {}) : process(arguments(robot, options)) {
    if (!process.says("\n")) return;
    const std::string line = process.output();
    const std::size_t start = line.find("ready at ");
    if (start != std::string::npos) address = line.substr(start + 9, line.find('\n', start) - start - 9);
  }
  static std::vector<std::string> arguments(const std::string& robot, std::vector<std::string> options) {
    options.insert(options.begin(), {test::built_program("heel-sim"), "--robot", robot});
    return options;
  }

  Process process;
  std::string address;
};

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
  Sim sim(robot());
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
  Sim sim(robot());
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
  Sim sim(robot());
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
  Sim sim(robot());
  for (int i = 0; i < 3; ++i) {
    RawClient client = RawClient::at(sim.address);
    EXPECT_TRUE(client.sync()) << "client " << i;
    client.hang_up();
    EXPECT_TRUE(eventually([&] { return occurrences(sim.process.output(), "client gone") > i; }));
  }
}

TEST_P(HeelSim, PacketsTakeTheTransmissionTimeOfTheLine) {
  Sim sim(robot());
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
  Sim sim(robot(), {"--fault", "left_open@0", "--fault", "bumper@0.2=4"});
  ASSERT_TRUE(sim.process.says("fault bumper"));
  RawClient client = RawClient::at(sim.address);
  const auto bumped = [](const Bytes& body) { return is_sip(body) && body.at(13) == 4 << 1; };
  EXPECT_FALSE(client.wait_for(bumped).empty()) << "no front bumper in the high byte";
}

TEST_P(HeelSim, TruthHasARowEvery20Ms) {
  const std::string path = folder.file("truth.csv");
  Sim sim(robot(), {"--truth", path, "--duration", "5", "--exact", "--fault", "left_open@0=300"});
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

TEST(HeelSimOnPty, KeepsItsRateAndAtAnotherRateBytesAreDamagedInBothDirections) {
  TemporaryFolder folder;
  Sim sim("pty:" + folder.file("robot"));
  RawClient client = RawClient::at(sim.address);
  client.set_rate(B38400);
  for (int i = 0; i < 3; ++i) {
    client.send(0);
    client.listen(0.2);
  }
  EXPECT_TRUE(client.packets.empty());
  client.set_rate(B9600);
  client.listen(0.4);
  EXPECT_TRUE(client.sync());
  client.send(kOpen);
  ASSERT_FALSE(client.next_sip().empty());
  client.set_rate(B115200);
  EXPECT_TRUE(eventually([&] {
    client.packets.clear();
    const std::size_t before = client.raw.size();
    client.listen(0.5);
    return client.packets.empty() && client.raw.size() > before;
  })) << "expected bytes without a good packet";
}

TEST(HeelSimOnPty, ChangesItsRateAsTheAriaClientAsks) {
  TemporaryFolder folder;
  Sim sim("pty:" + folder.file("robot"));
  RawClient client = RawClient::at(sim.address);
  client.set_rate(B9600);
  ASSERT_TRUE(client.sync());
  client.send(kOpen, 1);
  // The robot returns to the old rate when the client, on a busy machine, is too late at the new one.
  bool kept = false;
  for (int i = 0; i < 10 && !kept; ++i) {
    client.set_rate(B9600);
    ASSERT_FALSE(client.next_sip().empty());
    client.send(kHostBaud, 2);
    sleep_s(0.01);
    client.set_rate(B38400);
    sleep_s(0.01);
    client.send(0);
    kept = !client.next_sip(0.9).empty();
  }
  EXPECT_TRUE(kept);
  EXPECT_TRUE(sim.process.says("baud 38400"));
  for (int i = 0; i < 20; ++i) ASSERT_FALSE(client.next_sip().empty()) << "SIP " << i;
}

TEST(HeelSimOnPty, FallsBackToItsBootRateAfterCloseUnlessItIsToldToStay) {
  for (const bool stays : {false, true}) {
    TemporaryFolder folder;
    Sim sim("pty:" + folder.file("robot"), {"--after-close", stays ? "stay" : "fall-back"});
    RawClient client = RawClient::at(sim.address);
    client.set_rate(B9600);
    ASSERT_TRUE(client.sync());
    client.send(kOpen, 1);
    ASSERT_FALSE(client.next_sip().empty());
    client.send(kHostBaud, 2);
    ASSERT_TRUE(sim.process.says("baud 38400"));
    client.set_rate(B38400);
    ASSERT_TRUE(eventually([&] {  // a rate of the terminal is read once a millisecond
      client.send(kClose, 1);
      return sim.process.output().find("closed") != std::string::npos;
    }));
    client.set_rate(stays ? B38400 : B9600);
    EXPECT_TRUE(client.sync());
    EXPECT_EQ(sim.process.output().find("baud 9600") != std::string::npos, !stays);
  }
}

TEST(HeelSimOnPty, TheSymlinkIsRemovedAtTheEndAndAnOldOneIsReplaced) {
  TemporaryFolder folder;
  const std::string path = folder.file("robot");
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) {
    Sim sim("pty:" + path);
    EXPECT_TRUE(std::filesystem::is_symlink(path));
    sim.process.signal(number);
    EXPECT_EQ(sim.process.wait(), 0);
    EXPECT_FALSE(std::filesystem::is_symlink(path));
  }
  {
    Sim killed("pty:" + path);
    killed.process.signal(SIGKILL);
    killed.process.wait();
  }
  EXPECT_TRUE(std::filesystem::is_symlink(path)) << "a killed process cannot remove it";
  Sim again("pty:" + path);
  RawClient client = RawClient::at(again.address);
  EXPECT_TRUE(client.sync());
}

TEST(HeelSimOnPty, TheSymlinkOfAnotherProcessIsNotRemoved) {
  TemporaryFolder folder;
  const std::string path = folder.file("robot");
  Sim sim("pty:" + path);
  ASSERT_NE(sim.address, "");
  std::filesystem::remove(path);
  std::filesystem::create_symlink("/dev/null", path);  // what another program put there
  sim.process.signal(SIGTERM);
  EXPECT_EQ(sim.process.wait(), 0);
  EXPECT_TRUE(std::filesystem::is_symlink(path));
}

TEST(HeelSimOnPty, ASecondHeelSimIsToldWhoServesThePathAndTheFirstGoesOn) {
  TemporaryFolder folder;
  const std::string path = folder.file("robot");
  Sim first("pty:" + path);
  RawClient client = RawClient::at(first.address);
  ASSERT_TRUE(client.sync());
  for (const std::string& same : {path, folder.path().string() + "/./robot"}) {
    Sim second("pty:" + same);
    EXPECT_EQ(second.process.wait(), 1);
    EXPECT_NE(second.process.output().find("another heel-sim (process "), std::string::npos)
        << second.process.output();
  }
  client.send(kOpen);
  EXPECT_FALSE(client.next_sip().empty());
  Sim elsewhere("pty:" + folder.file("robot2"));
  EXPECT_NE(elsewhere.address, "");
}

TEST(HeelSimOnTcp, ASecondHeelSimCannotHaveThePort) {
  Sim first("tcp:0");
  Sim second(first.address);
  EXPECT_EQ(second.process.wait(), 1);
  EXPECT_NE(second.process.output().find("Address already in use (by another heel-sim?)"), std::string::npos)
      << second.process.output();
}

TEST(HeelSimOnTcp, ASecondClientIsToldAndRefusedAndServedWhenTheFirstHasGone) {
  Sim sim("tcp:0");
  RawClient first = RawClient::at(sim.address);
  ASSERT_TRUE(first.sync());
  {
    RawClient second = RawClient::at(sim.address);
    EXPECT_TRUE(second.is_hung_up_on());
    EXPECT_EQ(std::string(second.raw.begin(), second.raw.end()), "heel-sim: in use by another client\r\n");
  }
  EXPECT_TRUE(sim.process.says("another client refused"));
  first.send(kOpen);
  EXPECT_FALSE(first.next_sip().empty()) << "the first goes on";
  first.hang_up();
  ASSERT_TRUE(sim.process.says("client gone"));
  RawClient third = RawClient::at(sim.address);
  third.send(0);
  EXPECT_FALSE(third.next_sip().empty()) << "the robot is still open";
}

struct BadOption {
  std::string name;
  std::vector<std::string> arguments;
  std::string complaint;
};
void PrintTo(const BadOption& bad, std::ostream* out) {
  *out << testing::PrintToString(bad.arguments);
}
class HeelSimOptions : public testing::TestWithParam<BadOption> {};

TEST_P(HeelSimOptions, AreRefusedByNameAndExpectation) {
  std::vector<std::string> argv = GetParam().arguments;
  argv.insert(argv.begin(), test::built_program("heel-sim"));
  Process process(argv);
  EXPECT_GT(process.wait(), 0);
  EXPECT_NE(process.output().find(GetParam().complaint), std::string::npos) << process.output();
}

INSTANTIATE_TEST_SUITE_P(
    CommandLines, HeelSimOptions,
    testing::Values(
        BadOption{"NoRobot", {}, "--robot"},
        BadOption{"AnUnknownLine", {"--robot", "usb:1"}, "--robot usb:1: not an address (expected pty:PATH"},
        BadOption{"APtyWithoutAPath", {"--robot", "pty:"}, "not an address (expected pty:PATH"},
        BadOption{
            "APortThatIsNoNumber", {"--robot", "tcp:seven"}, "'seven' is not a port (expected 0…65535)"},
        BadOption{"APortTooGreat", {"--robot", "tcp:70000"}, "'70000' is not a port"},
        BadOption{"AFileInPlaceOfALink", {"--robot", "pty:/proc/version"}, "exists and is not a symlink"},
        BadOption{
            "AFolderThatIsMissing", {"--robot", "pty:/no-such-folder/robot"}, "cannot make the symlink"},
        BadOption{"ABaudRateThatArcosLacks", {"--robot", "tcp:0", "--boot-baud", "1200"}, "--boot-baud"},
        BadOption{"AnUnknownRateAfterClose", {"--robot", "tcp:0", "--after-close", "keep"}, "--after-close"},
        BadOption{"AnUnknownModel", {"--robot", "tcp:0", "--model", "roomba"}, "--model"},
        BadOption{"AFaultWithoutAStart", {"--robot", "tcp:0", "--fault", "drop"}, "fault 'drop': no start"},
        BadOption{"AnOptionMisspelt", {"--robot", "tcp:0", "--fualt", "drop@1"}, "--fualt"},
        BadOption{"ATruthFileThatCannotBe",
                  {"--robot", "tcp:0", "--truth", "/no-such-folder/t.csv"},
                  "cannot write"}),
    [](const auto& option) { return option.param.name; });

}  // namespace
}  // namespace heel
