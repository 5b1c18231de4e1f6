// The control thread's loop with a simulated P3-AT over a pty in real time: its records hold the inputs of
// its decisions.
#include "daemon/control_loop.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "loopback/robot/robot_thread.h"
#include "models/robot_models.h"
#include "support/decisions.h"
#include "support/process.h"

namespace heel {
namespace {

/// A person straight ahead who keeps 1 m more than the template's distance, whatever the robot does.
PoseEstimate pose_of_frame(std::uint64_t sequence, TimeNs t_capture_ns) {
  PoseEstimate pose;
  pose.frame_sequence = sequence;
  pose.t_capture_ns = t_capture_ns;
  pose.reason = PoseReason::Found;
  pose.certainty = 0.4;
  pose.R_cur_from_ref = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  pose.t_over_d = {0, 0, 0.5};
  pose.has_distance = true;
  pose.position_m = {0, 0, 3.0};
  return pose;
}

TEST(ControlLoopOverPty, TheRecordedInputsGiveTheRecordedDecisions) {
  const std::string address = test::pty_address("control");
  const test::RobotThread robot(address);
  Config config;
  config.robot.address = address;
  config.robot.config_wait_s = 0.2;
  config.supervisor.start = "at_once";
  Mailbox<PoseEstimate> poses;
  TelemetryQueues queues;
  ControlLoop loop(config, poses, queues);
  std::vector<TickRecord> records;
  const auto drain = [&] {
    for (TickRecord record; queues.ticks.pop(record);) records.push_back(record);
  };
  {
    std::jthread thread([&] { loop.run(); });
    const TimeNs t_end_ns = monotonic_now_ns() + ns_from_seconds(test::kPatience_s);
    int moving = 0;
    for (std::uint64_t frame = 1; moving < 50 && monotonic_now_ns() < t_end_ns; ++frame) {
      poses.post(pose_of_frame(frame, monotonic_now_ns()));
      sleep_until_ns(monotonic_now_ns() + 33 * kNsPerMs);
      drain();
      moving += robot.truth().v_m_s > 0.1;
    }
    loop.stop();
  }
  drain();

  ControlStage again(config, robot_models());
  test::DecisionCounts counts;
  for (const TickRecord& record : records) {
    ASSERT_EQ(test::decision_bytes(again.tick(record.input)), test::decision_bytes(record)) << record.tick;
    counts.add(record);
  }
  EXPECT_GT(counts.moving, 50);
  EXPECT_GT(counts.accepted, 30);
  EXPECT_GT(counts.sonar_readings, 10);
  EXPECT_EQ(queues.ticks.dropped(), 0U);
  ASSERT_FALSE(records.empty());
  EXPECT_EQ(records.back().stop_reason, StopReason::Shutdown);
}

/// The loop on a robot, with a person in each frame and the newest tick.
class OperatedLoop {
 public:
  explicit OperatedLoop(const std::string& address)
      : config_(config_of(address)), loop_(config_, poses_, queues_) {
    thread_ = std::jthread([this] { loop_.run(); });
  }
  ~OperatedLoop() { loop_.stop(); }

  const TickRecord& record() const { return record_; }
  /// Until `holds`; false: it never did.
  template <typename Holds>
  bool until(Holds holds) {
    for (const TimeNs t_end_ns = monotonic_now_ns() + ns_from_seconds(test::kPatience_s);
         monotonic_now_ns() < t_end_ns;) {
      if (monotonic_now_ns() - t_frame_ns_ > 33 * kNsPerMs) {
        t_frame_ns_ = monotonic_now_ns();
        poses_.post(pose_of_frame(++frame_, t_frame_ns_));
      }
      for (TickRecord tick; queues_.ticks.pop(tick);) record_ = tick;
      if (holds()) return true;
      sleep_until_ns(monotonic_now_ns() + kNsPerMs);
    }
    return false;
  }
  OperatorOutcome answer_to(OperatorCommand command) {
    loop_.request({++number_, monotonic_now_ns(), command});
    TickRecord tick;
    const bool answered =
        until([&] { return loop_.take_operator_status(tick) && tick.request_number == number_; });
    EXPECT_TRUE(answered);
    return tick.outcome;
  }
  bool stays_at_rest(double seconds) {
    const TimeNs t_end_ns = monotonic_now_ns() + ns_from_seconds(seconds);
    bool moved = false;
    return until([&] {
             moved = moved || record_.command.v_m_s != 0.0;
             return monotonic_now_ns() >= t_end_ns;
           }) &&
           !moved;
  }

 private:
  static Config config_of(const std::string& address) {
    Config config;
    config.robot.address = address;
    config.robot.config_wait_s = 0.2;
    return config;
  }
  Config config_;
  Mailbox<PoseEstimate> poses_;
  TelemetryQueues queues_;
  ControlLoop loop_;
  TickRecord record_;
  std::uint64_t frame_ = 0, number_ = 0;
  TimeNs t_frame_ns_ = 0;
  std::jthread thread_;
};

TEST(ControlLoopOverPty, MovesAfterAStartAndAfterTheStopButtonByResetAndStart) {
  const std::string address = test::pty_address("operated");
  test::RobotThread robot(address);
  OperatedLoop loop(address);
  const auto drives = [&] { return robot.truth().v_m_s > 0.1; };
  ASSERT_TRUE(loop.until([&] { return loop.record().input.robot.phase == LinkPhase::Running; }));
  EXPECT_TRUE(loop.stays_at_rest(0.5));
  EXPECT_EQ(loop.answer_to(OperatorCommand::Start), OperatorOutcome::Done);
  ASSERT_TRUE(loop.until(drives));

  robot.press_stop_button(true);
  ASSERT_TRUE(loop.until([&] { return loop.record().state == SupervisorState::Stopped; }));
  EXPECT_EQ(loop.answer_to(OperatorCommand::Reset), OperatorOutcome::Refused);
  robot.press_stop_button(false);
  ASSERT_TRUE(loop.until([&] { return !loop.record().input.robot.stop_button; }));
  EXPECT_EQ(loop.answer_to(OperatorCommand::Start), OperatorOutcome::Refused);
  EXPECT_EQ(loop.answer_to(OperatorCommand::Reset), OperatorOutcome::Done);
  ASSERT_TRUE(loop.until([&] { return loop.record().input.robot.phase == LinkPhase::Running; }));
  EXPECT_TRUE(loop.stays_at_rest(0.5));
  EXPECT_EQ(loop.answer_to(OperatorCommand::Start), OperatorOutcome::Done);
  ASSERT_TRUE(loop.until(drives));

  EXPECT_EQ(loop.answer_to(OperatorCommand::EStop), OperatorOutcome::Done);
  ASSERT_TRUE(loop.until([&] { return loop.record().state == SupervisorState::Emergency; }));
  EXPECT_TRUE(loop.stays_at_rest(0.5));
}

}  // namespace
}  // namespace heel
