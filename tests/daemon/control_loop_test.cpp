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

TEST(ControlLoop, AnEmergencyStopIsHandledBeforeAnyOtherRequest) {
  Config config;
  config.robot.address = "pty:/nonexistent/robot";
  Mailbox<PoseEstimate> poses;
  TelemetryQueues queues;
  ControlLoop loop(config, poses, queues);
  loop.request({1, monotonic_now_ns(), OperatorCommand::Start});
  loop.request({2, monotonic_now_ns(), OperatorCommand::EStop});
  loop.request({3, monotonic_now_ns(), OperatorCommand::Start});
  std::jthread thread([&] { loop.run(); });
  TickRecord record;
  const auto next = [&] {
    while (!queues.ticks.pop(record)) sleep_until_ns(monotonic_now_ns() + kNsPerMs);
    return record;
  };
  EXPECT_EQ(next().request_number, 2U);
  EXPECT_EQ(record.outcome, OperatorOutcome::Done);
  EXPECT_EQ(record.state, SupervisorState::Emergency);
  EXPECT_EQ(next().request_number, 3U);
  EXPECT_EQ(record.outcome, OperatorOutcome::Refused);
  EXPECT_EQ(record.refused_by, StopReason::EmergencyStop);
  EXPECT_EQ(record.input.t_operator_ns, record.input.request.t_ns);

  const TimeNs t_alive_ns = monotonic_now_ns();
  loop.operator_alive(t_alive_ns);
  while (next().input.t_operator_ns < t_alive_ns) ASSERT_LT(record.tick, 1000U);
  EXPECT_EQ(record.input.t_operator_ns, t_alive_ns);
  TickRecord status;
  EXPECT_TRUE(loop.take_operator_status(status));
  EXPECT_EQ(status.request_number, 3U);
  loop.stop();
  thread.join();
}

TEST(ControlLoop, AStartThatHasWaitedTooLongIsNotDone) {
  Config config;
  config.robot.address = "pty:/nonexistent/robot";
  Mailbox<PoseEstimate> poses;
  TelemetryQueues queues;
  ControlLoop loop(config, poses, queues);
  loop.request({1, monotonic_now_ns() - kNsPerS, OperatorCommand::Start});
  std::jthread thread([&] { loop.run(); });
  TickRecord record;
  while (!queues.ticks.pop(record)) sleep_until_ns(monotonic_now_ns() + kNsPerMs);
  EXPECT_EQ(record.request_number, 1U);
  EXPECT_EQ(record.outcome, OperatorOutcome::AlreadySo) << "a start would be refused: there is no robot";
  loop.stop();
  thread.join();
}

TEST(ControlLoop, AnOlderRequestThatWaitsBehindAnEmergencyStopIsNotHandled) {
  Config config;
  config.robot.address = "pty:/nonexistent/robot";
  Mailbox<PoseEstimate> poses;
  TelemetryQueues queues;
  ControlLoop loop(config, poses, queues);
  loop.request({1, monotonic_now_ns(), OperatorCommand::Reset});
  loop.request({2, monotonic_now_ns(), OperatorCommand::EStop});
  std::jthread thread([&] { loop.run(); });
  TickRecord record;
  for (int ticks = 0; ticks < 5;) {
    if (!queues.ticks.pop(record)) {
      sleep_until_ns(monotonic_now_ns() + kNsPerMs);
      continue;
    }
    ++ticks;
    EXPECT_EQ(record.request_number, 2U);
    EXPECT_EQ(record.state, SupervisorState::Emergency);
  }
  loop.stop();
  thread.join();
}

}  // namespace
}  // namespace heel
