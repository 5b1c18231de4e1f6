// systemd's watchdog is fed only while the control loop runs.
#include "daemon/status_reporter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "realtime/clock.h"
#include "support/environment.h"
#include "support/full_notify_socket.h"
#include "support/process.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using ::testing::Contains;
using ::testing::Not;

TEST(StatusReporter, FeedsTheWatchdogOnlyWhileTheControlLoopRuns) {
  const test::TemporaryFolder folder;
  test::FullNotifySocket socket(folder.file("notify"));
  socket.take();
  const test::ScopedEnvironment name("NOTIFY_SOCKET", socket.name());
  const test::ScopedEnvironment timeout("WATCHDOG_USEC", "3000");  // due at each update
  const test::ScopedEnvironment pid("WATCHDOG_PID", std::to_string(getpid()));
  Config config;
  config.robot.address = "pty:/nonexistent/robot";
  Mailbox<PoseEstimate> poses;
  TelemetryQueues queues;
  ControlLoop loop(config, poses, queues);
  StatusReporter reporter(config.runtime);

  std::vector<std::string> messages;
  const auto update = [&] {
    reporter.update(loop, false, monotonic_now_ns());
    for (std::string& message : socket.take()) messages.push_back(std::move(message));
  };
  update();
  EXPECT_THAT(messages, Not(Contains("WATCHDOG=1"))) << "the loop has not started";

  std::jthread thread([&] { loop.run(); });
  const bool fed = test::eventually([&] {
    update();
    return std::find(messages.begin(), messages.end(), "WATCHDOG=1") != messages.end();
  });
  EXPECT_TRUE(fed) << "the loop runs";
  loop.stop();
  thread.join();

  test::sleep_s(0.6);  // longer than a tick may be late
  messages.clear();
  update();
  EXPECT_THAT(messages, Not(Contains("WATCHDOG=1"))) << "the loop has ended";
}

}  // namespace
}  // namespace heel
