#include "operator/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace heel {

OperatorCommand command_of(RequestKind kind) {
  switch (kind) {
    case RequestKind::Start:
      return OperatorCommand::Start;
    case RequestKind::Stop:
      return OperatorCommand::Stop;
    case RequestKind::EStop:
      return OperatorCommand::EStop;
    case RequestKind::Reset:
      return OperatorCommand::Reset;
    default:
      return OperatorCommand::None;
  }
}

void CommandQueue::add(OperatorCommand command, std::uint64_t ticket, TimeNs now_ns) {
  if (command == OperatorCommand::EStop) {
    if (current_) give_up(*current_, "not done: an emergency stop came before it was handled");
    for (const Posted& one : waiting_) give_up(one, "not done: an emergency stop came before it");
    current_.reset();
    waiting_.clear();
    emergency_stops_.push_back({port_.request(command, now_ns), ticket});
    return;
  }
  Posted later{{0, now_ns, command}, ticket};
  if (waiting_.size() >= kMaxWaiting) {
    give_up(later, fmt::format("not done: {} commands wait already", kMaxWaiting));
    return;
  }
  waiting_.push_back(later);
  post_next(now_ns);
}

std::vector<CommandResult> CommandQueue::settle(const TickRecord& tick, TimeNs now_ns) {
  settle_emergency_stops(tick, now_ns);
  if (current_) settle_current(tick, now_ns);
  post_next(now_ns);
  return std::exchange(results_, {});
}

/// Several may have come within one tick: the newest number stands for all of them.
void CommandQueue::settle_emergency_stops(const TickRecord& tick, TimeNs now_ns) {
  const auto done = [&](const Posted& posted) {
    if (tick.request_number >= posted.request.number) {
      const bool newest = tick.request_number == posted.request.number;
      if (tick.state == SupervisorState::Emergency) {
        const OperatorOutcome outcome = newest ? tick.outcome : OperatorOutcome::AlreadySo;
        results_.push_back({posted.ticket, OperatorCommand::EStop, outcome, ""});
      } else {
        give_up(posted, fmt::format("the state is {} (expected emergency)", to_string(tick.state)));
      }
      return true;
    }
    if (now_ns - posted.request.t_ns <= kPatience_ns) return false;
    // It is not withdrawn: whenever the loop runs again, it stops.
    give_up(posted, "the control loop did not answer within 0.5 s; it stops when it runs again");
    return true;
  };
  std::erase_if(emergency_stops_, done);
}

void CommandQueue::settle_current(const TickRecord& tick, TimeNs now_ns) {
  const Posted& posted = *current_;
  if (tick.request_number == posted.request.number) {
    CommandResult result{posted.ticket, posted.request.command, tick.outcome, ""};
    if (tick.outcome == OperatorOutcome::Refused) result.error = refusal_text(tick);
    results_.push_back(std::move(result));
  } else if (tick.request_number > posted.request.number) {
    give_up(posted, "not done: an emergency stop came before it was handled");
  } else if (now_ns - posted.request.t_ns > kPatience_ns) {
    // A start that is handled later, when nobody expects it, would be dangerous.
    port_.request(OperatorCommand::None, now_ns);
    give_up(posted, "the control loop did not answer within 0.5 s; the request is withdrawn");
  } else {
    return;
  }
  current_.reset();
}

void CommandQueue::post_next(TimeNs now_ns) {
  // Before the next one goes: its asker may expect no more that it is done.
  while (!waiting_.empty() && now_ns - waiting_.front().request.t_ns > kPatience_ns) {
    give_up(waiting_.front(), "not done: it waited more than 0.5 s for those before it");
    waiting_.pop_front();
  }
  if (current_ || !emergency_stops_.empty() || waiting_.empty()) return;
  const Posted next = waiting_.front();
  waiting_.pop_front();
  current_ = Posted{port_.request(next.request.command, now_ns), next.ticket};
}

void CommandQueue::give_up(const Posted& posted, std::string error) {
  results_.push_back({posted.ticket, posted.request.command, OperatorOutcome::None, std::move(error)});
}

std::string refusal_text(const TickRecord& tick) {
  return fmt::format("refused: {}", to_string(tick.refused_by));
}

}  // namespace heel
