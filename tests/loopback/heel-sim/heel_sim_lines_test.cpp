// The pty and the TCP port of heel-sim: rates, the symlink, and who is served.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "loopback/heel-sim/raw_client.h"
#include "loopback/heel-sim/running_sim.h"
#include "support/process.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::eventually;
using test::kClose;
using test::kHostBaud;
using test::kOpen;
using test::RawClient;
using test::RunningSim;
using test::sleep_s;
using test::TemporaryFolder;

TEST(HeelSimOnPty, KeepsItsRateAndAtAnotherRateBytesAreDamagedInBothDirections) {
  TemporaryFolder folder;
  RunningSim sim("pty:" + folder.file("robot"));
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
  RunningSim sim("pty:" + folder.file("robot"));
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
    RunningSim sim("pty:" + folder.file("robot"), {"--after-close", stays ? "stay" : "fall-back"});
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
    RunningSim sim("pty:" + path);
    EXPECT_TRUE(std::filesystem::is_symlink(path));
    sim.process.signal(number);
    EXPECT_EQ(sim.process.wait(), 0);
    EXPECT_FALSE(std::filesystem::is_symlink(path));
  }
  {
    RunningSim killed("pty:" + path);
    killed.process.signal(SIGKILL);
    killed.process.wait();
  }
  EXPECT_TRUE(std::filesystem::is_symlink(path)) << "a killed process cannot remove it";
  RunningSim again("pty:" + path);
  RawClient client = RawClient::at(again.address);
  EXPECT_TRUE(client.sync());
}

TEST(HeelSimOnPty, TheSymlinkOfAnotherProcessIsNotRemoved) {
  TemporaryFolder folder;
  const std::string path = folder.file("robot");
  RunningSim sim("pty:" + path);
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
  RunningSim first("pty:" + path);
  RawClient client = RawClient::at(first.address);
  ASSERT_TRUE(client.sync());
  for (const std::string& same : {path, folder.path().string() + "/./robot"}) {
    RunningSim second("pty:" + same);
    EXPECT_EQ(second.process.wait(), 1);
    EXPECT_NE(second.process.output().find("another heel-sim (process "), std::string::npos)
        << second.process.output();
  }
  client.send(kOpen);
  EXPECT_FALSE(client.next_sip().empty());
  RunningSim elsewhere("pty:" + folder.file("robot2"));
  EXPECT_NE(elsewhere.address, "");
}

TEST(HeelSimOnTcp, ASecondHeelSimCannotHaveThePort) {
  RunningSim first("tcp:0");
  RunningSim second(first.address);
  EXPECT_EQ(second.process.wait(), 1);
  EXPECT_NE(second.process.output().find("Address already in use (by another heel-sim?)"), std::string::npos)
      << second.process.output();
}

TEST(HeelSimOnTcp, ASecondClientIsToldAndRefusedAndServedWhenTheFirstHasGone) {
  RunningSim sim("tcp:0");
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

}  // namespace
}  // namespace heel
