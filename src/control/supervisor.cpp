#include "control/supervisor.h"

namespace heel {

Supervisor::Supervisor(const SupervisorConfig& config) : at_once_(config.start == "at_once") {}

OperatorCommand Supervisor::new_command(const OperatorRequest& request) const {
  return request.number > verdict_.request_number ? request.command : OperatorCommand::None;
}

Verdict Supervisor::update(const ControlInput& input, Conditions conditions, bool law_may_search,
                           const SupervisorConfig& config) {
  const SupervisorState before = verdict_.state;
  const TimeNs in_state_ns = input.now_ns - verdict_.t_transition_ns;
  const bool search_over =
      before == SupervisorState::Searching && in_state_ns > ns_from_seconds(config.search_s);
  SupervisorFacts facts;
  facts.conditions = conditions;
  facts.command = new_command(input.request);
  facts.button_pressed = input.robot.stop_button;
  facts.may_search = law_may_search && !search_over && config.search_s > 0.0;
  if (facts.command != OperatorCommand::None) started_ = true;
  if (facts.command == OperatorCommand::Stop) halted_ = true;
  const bool can_start = (conditions & kFaults) == 0 && before != SupervisorState::Emergency;
  if (facts.command == OperatorCommand::Start && can_start) halted_ = false;
  facts.first_start = at_once_ && !started_;
  facts.resumes = at_once_ && !halted_;

  verdict_.enable_motors = false;
  take_transitions(facts, input.now_ns);
  if (input.request.number > verdict_.request_number) {
    verdict_.request_number = input.request.number;
    answer(facts.command, before, facts);
  }
  const bool fault = (conditions & kFaults) != 0;
  verdict_.style = fault ? StopStyle::AtOnce : style_of(verdict_.state);
  verdict_.stop_reason = stop_reason(conditions);
  verdict_.needs_start = (verdict_.state == SupervisorState::Idle && !facts.first_start) ||
                         (verdict_.state == SupervisorState::Stopped && !facts.resumes) ||
                         verdict_.state == SupervisorState::Emergency;
  return verdict_;
}

/// Goes on until the state stays: a start with the target in view leads through Armed to Following in one
/// tick. The table has no circle (a test goes through all facts). A command acts on the first state only.
void Supervisor::take_transitions(SupervisorFacts facts, TimeNs now_ns) {
  while (const StateRow* const row = next_row(verdict_.state, facts)) {
    verdict_.state = row->to;
    verdict_.cause = cause_of(row->trigger, facts.conditions);
    verdict_.t_transition_ns = now_ns;
    started_ = true;
    facts.first_start = false;
    facts.command = OperatorCommand::None;
    if (row->trigger == Trigger::Fault) fault_ = first_condition(facts.conditions)->reason;
  }
}

void Supervisor::answer(OperatorCommand command, SupervisorState before, const SupervisorFacts& facts) {
  const bool faulty = (facts.conditions & kFaults) != 0;
  const bool at_rest = before == SupervisorState::Idle || before == SupervisorState::Stopped ||
                       before == SupervisorState::Emergency;
  const auto done_if = [](bool done) { return done ? OperatorOutcome::Done : OperatorOutcome::AlreadySo; };
  const auto refuse = [this](StopReason reason) {
    verdict_.refused_by = reason;
    return OperatorOutcome::Refused;
  };
  verdict_.refused_by = StopReason::None;
  switch (command) {
    case OperatorCommand::None:
      verdict_.outcome = OperatorOutcome::AlreadySo;
      break;
    case OperatorCommand::EStop:
      verdict_.outcome = done_if(before != SupervisorState::Emergency);
      break;
    case OperatorCommand::Stop:
      verdict_.outcome = done_if(!at_rest);
      break;
    case OperatorCommand::Start:
      verdict_.outcome = before == SupervisorState::Emergency ? refuse(StopReason::EmergencyStop)
                         : faulty ? refuse(first_condition(facts.conditions)->reason)
                                  : done_if(at_rest);
      break;
    case OperatorCommand::Reset: {
      const bool motors_off = (facts.conditions & (kMotorsOff | kStopButton)) != 0;
      const bool to_reset = before == SupervisorState::Stopped || before == SupervisorState::Emergency ||
                            (motors_off && (facts.conditions & kLinkDown) == 0);
      verdict_.outcome = facts.button_pressed ? refuse(StopReason::StopButton) : done_if(to_reset);
      verdict_.enable_motors = verdict_.outcome != OperatorOutcome::Refused;
      break;
    }
  }
}

StopReason Supervisor::stop_reason(Conditions conditions) const {
  const ConditionRow* const first = first_condition(conditions);
  const bool fault = (conditions & kFaults) != 0;
  switch (verdict_.state) {
    case SupervisorState::Idle:
      return fault ? first->reason : StopReason::NotStarted;
    case SupervisorState::Stopped:
      return fault ? first->reason : fault_;
    case SupervisorState::Emergency:
      return (conditions & kShutdown) != 0 ? StopReason::Shutdown : StopReason::EmergencyStop;
    case SupervisorState::Armed:
    case SupervisorState::Following:
    case SupervisorState::Searching:
    case SupervisorState::Waiting:
      break;
  }
  return first != nullptr ? first->reason : StopReason::None;
}

}  // namespace heel
