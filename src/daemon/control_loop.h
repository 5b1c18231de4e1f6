// The body of the control thread: once a period, the newest pose and the robot's state become one command. It
// alone uses the robot's line, and it always ends with STOP and CLOSE.
#pragma once

#include <atomic>

#include "control/control_stage.h"
#include "core/config.h"
#include "realtime/clock.h"
#include "realtime/mailbox.h"
#include "robot/robot_link.h"
#include "telemetry/telemetry_queues.h"

namespace heel {

class ControlLoop {
 public:
  /// Everything is borrowed and must outlive run(). Opening the line begins here.
  ControlLoop(const Config& config, Mailbox<PoseEstimate>& poses, TelemetryQueues& queues);

  /// Until stop(); then the robot is stopped and the line closed. Does not allocate, lock or format.
  void run();
  /// From any thread.
  void stop() { stop_.store(true, std::memory_order_relaxed); }
  /// STOP, SONAR 0, CLOSE, for a thread whose run() has ended by an exception; nothing when already done.
  void shut_robot_down();

  /// From one thread at a time (ControlPort sees to it): the newest request replaces one that no tick has
  /// taken yet, but an emergency stop is never replaced. Wait-free. A tick's `request_number` tells when it
  /// was handled; a number that is already larger: it was replaced.
  void request(const OperatorRequest& request);
  /// From the operator thread: a sign that the operator is there (supervisor.operator_timeout_s).
  void operator_alive(TimeNs t_ns) { t_operator_ns_.store(t_ns, std::memory_order_relaxed); }
  /// For the operator thread: true and the newest tick, when there is one not taken before.
  bool take_operator_status(TickRecord& out) { return operator_status_.take(out); }

  /// From the settings thread: offers a configuration, taken over before the next tick. `config` must live
  /// until the call returns. False: the loop did not take it within the timeout.
  bool reconfigure(const Config& config, TimeNs timeout_ns);

  // For the main thread:
  /// True and the newest tick, when there is one not taken before.
  bool take_status(TickRecord& out) { return status_.take(out); }
  TimeNs heartbeat_ns() const { return heartbeat_ns_.load(std::memory_order_relaxed); }
  std::uint64_t open_failures() const { return link_.open_failures(); }
  std::string last_open_error() const { return link_.last_open_error(); }
  std::uint64_t open_notes() const { return link_.open_notes(); }
  std::string last_open_note() const { return link_.last_open_note(); }

 private:
  TimeNs wait_for_tick();
  void tick(TimeNs lateness_ns);
  void apply_offered_configuration();
  void read_inputs(TimeNs now_ns, TimeNs lateness_ns);
  void read_operator();
  void report_robot_events();
  void publish(const TickRecord& record);

  RobotLink link_;
  ControlStage stage_;
  PeriodicDeadline deadline_;
  Mailbox<PoseEstimate>& poses_;
  TelemetryQueues& queues_;

  ControlInput input_;
  std::uint64_t overruns_ = 0;

  Mailbox<OperatorRequest> requests_;            // operator → control
  Mailbox<OperatorRequest> emergency_stops_;     // operator → control; taken before `requests_`
  std::atomic<TimeNs> t_operator_ns_{0};         // operator → control
  Mailbox<TickRecord> operator_status_;          // control → operator
  Mailbox<TickRecord> status_;                   // control → main
  std::atomic<const Config*> offered_{nullptr};  // settings → control
  std::atomic<const Config*> taken_{nullptr};    // control → settings
  std::atomic<bool> stop_{false};
  std::atomic<TimeNs> heartbeat_ns_{0};
};

}  // namespace heel
