#include "daemon/control_loop.h"

#include <algorithm>

#include "models/robot_models.h"
#include "realtime/hot_section.h"
#include "robot/session_event_text.h"

namespace heel {
namespace {

// A start that has waited longer, because the process was stopped or had no processor, is not done.
constexpr TimeNs kOldestStart_ns = 500 * kNsPerMs;

}  // namespace

ControlLoop::ControlLoop(const Config& config, Mailbox<PoseEstimate>& poses, TelemetryQueues& queues)
    : link_(config.robot, &queues.wire),
      stage_(config, robot_models()),
      deadline_(ns_from_seconds(1.0 / config.control.rate_hz), monotonic_now_ns()),
      poses_(poses),
      queues_(queues) {}

void ControlLoop::run() {
  const HotSection hot;
  deadline_.restart(monotonic_now_ns());
  while (!stop_.load(std::memory_order_relaxed)) {
    const TimeNs lateness_ns = wait_for_tick();
    apply_offered_configuration();
    tick(lateness_ns);
  }
  input_.shutdown = true;
  tick(0);
  shut_robot_down();
}

void ControlLoop::tick(TimeNs lateness_ns) {
  read_inputs(monotonic_now_ns(), lateness_ns);
  const TickRecord record = stage_.tick(input_);
  if (record.enable_motors) link_.enable_motors_again(input_.now_ns);
  link_.write(record.command, input_.now_ns);
  report_robot_events();
  publish(record);
}

void ControlLoop::shut_robot_down() {
  link_.shutdown(monotonic_now_ns());
  report_robot_events();
}

/// Waits for the next deadline and returns the lateness. Meanwhile the robot's bytes are stamped as they
/// arrive.
TimeNs ControlLoop::wait_for_tick() {
  link_.receive_until(deadline_.next_ns());
  const TimeNs now_ns = monotonic_now_ns();
  const TimeNs lateness_ns = deadline_.advance(now_ns);
  heartbeat_ns_.store(now_ns, std::memory_order_relaxed);
  if (deadline_.overruns() != overruns_) {
    overruns_ = deadline_.overruns();
    Event event{.t_ns = now_ns, .kind = EventKind::Overrun, .a = static_cast<std::int64_t>(overruns_)};
    event.b = lateness_ns;
    queues_.control_events.push(event);
  }
  return lateness_ns;
}

void ControlLoop::apply_offered_configuration() {
  const Config* config = offered_.exchange(nullptr, std::memory_order_acquire);
  if (config == nullptr) return;
  stage_.reconfigure(*config);
  taken_.store(config, std::memory_order_release);
}

bool ControlLoop::reconfigure(const Config& config, TimeNs timeout_ns) {
  const TimeNs give_up_ns = monotonic_now_ns() + timeout_ns;
  taken_.store(nullptr, std::memory_order_relaxed);
  offered_.store(&config, std::memory_order_release);
  while (taken_.load(std::memory_order_acquire) != &config) {
    // Withdrawn, unless the loop has just picked it up: then it will be done in a moment.
    const bool late = monotonic_now_ns() > give_up_ns;
    if (late && offered_.exchange(nullptr, std::memory_order_acq_rel) != nullptr) return false;
    sleep_until_ns(monotonic_now_ns() + kNsPerMs);
  }
  return true;
}

void ControlLoop::request(const OperatorRequest& request) {
  (request.command == OperatorCommand::EStop ? emergency_stops_ : requests_).post(request);
}

void ControlLoop::read_inputs(TimeNs now_ns, TimeNs lateness_ns) {
  input_.now_ns = now_ns;
  input_.lateness_ns = lateness_ns;
  input_.robot = link_.read(now_ns);
  if (poses_.take(input_.pose)) input_.has_pose = true;
  read_operator();
}

void ControlLoop::read_operator() {
  // One request a tick. A request that waits behind an emergency stop and is older is never handled: its
  // number is no longer new.
  if (!emergency_stops_.take(input_.request) && requests_.take(input_.request)) {
    // Its operator has been told that nothing came of it.
    const bool too_old = input_.now_ns - input_.request.t_ns > kOldestStart_ns;
    if (too_old && input_.request.command == OperatorCommand::Start)
      input_.request.command = OperatorCommand::None;
  }
  input_.t_operator_ns =
      std::max({input_.t_operator_ns, input_.request.t_ns, t_operator_ns_.load(std::memory_order_relaxed)});
}

/// The session's events as they are, copied, not formatted.
void ControlLoop::report_robot_events() {
  SessionEvent news;
  while (link_.next_event(news)) {
    Event event{.t_ns = news.t_ns, .kind = is_warning(news.kind) ? EventKind::Warning : EventKind::Note};
    event.a = news.value;
    write_event_text(news, link_.state().kind, link_.heard_text(), event.text);
    queues_.control_events.push(event);
  }
}

void ControlLoop::publish(const TickRecord& record) {
  status_.post(record);
  operator_status_.post(record);
  queues_.ticks.push(record);
}

}  // namespace heel
