// The control thread's loop without a robot: when its deadlines start.
#include "daemon/control_loop.h"

#include <gtest/gtest.h>

#include <thread>

#include "realtime/clock.h"

namespace heel {
namespace {

TEST(ControlLoop, TheTimeBeforeTheThreadRunsIsNotLateness) {
  Config config;
  config.robot.address = "pty:/nonexistent/robot";
  Mailbox<PoseEstimate> poses;
  TelemetryQueues queues;
  ControlLoop loop(config, poses, queues);
  const TimeNs period_ns = ns_from_seconds(1.0 / config.control.rate_hz);
  sleep_until_ns(monotonic_now_ns() + 5 * period_ns);

  const TimeNs t_run_ns = monotonic_now_ns();
  std::jthread thread([&] { loop.run(); });
  TickRecord first;
  while (!queues.ticks.pop(first)) sleep_until_ns(monotonic_now_ns() + kNsPerMs);
  loop.stop();
  thread.join();

  // The first tick cannot be later than this on any machine, however busy.
  EXPECT_LE(first.input.lateness_ns, first.input.now_ns - t_run_ns - period_ns);
}

}  // namespace
}  // namespace heel
