// The supervisor's rules, written again in another form than the table, for tests that compare the two.
#pragma once

#include <array>

#include "control/condition_table.h"
#include "heel/flow.h"

namespace heel::test {

inline constexpr std::array kAllStates{SupervisorState::Idle,      SupervisorState::Armed,
                                       SupervisorState::Following, SupervisorState::Searching,
                                       SupervisorState::Waiting,   SupervisorState::Stopped,
                                       SupervisorState::Emergency};
inline constexpr std::array kAllCommands{OperatorCommand::None, OperatorCommand::Start, OperatorCommand::Stop,
                                         OperatorCommand::EStop, OperatorCommand::Reset};

inline constexpr Conditions kFaultBits = kShutdown | kLinkDown | kStaleSip | kStopButton | kMotorsOff |
                                         kBumper | kStall | kOverrun | kClockStep | kBatteryLow |
                                         kOperatorAway | kTurnsAway;
inline constexpr Conditions kSensesBits = kSonarSilent | kStaleFrame | kAmbiguous | kLowCertainty;

struct Circumstances {
  bool button_pressed = false;
  bool at_once = false;  ///< nothing has been started or stopped by an operator
  bool may_search = false;
};

/// A robot that is allowed to move, without a fault or a command.
inline SupervisorState expected_while_allowed(SupervisorState state, Conditions conditions, bool may_search) {
  const bool senses = (conditions & kSensesBits) == 0;
  const bool target = (conditions & (kTargetLost | kNoTargetYet)) == 0;
  if (senses && target) return SupervisorState::Following;
  if (state == SupervisorState::Armed || state == SupervisorState::Waiting) return state;
  return senses && may_search ? SupervisorState::Searching : SupervisorState::Waiting;
}

inline SupervisorState expected_state(SupervisorState state, Conditions conditions, OperatorCommand command,
                                      const Circumstances& now) {
  const bool fault = (conditions & kFaultBits) != 0;
  const bool reset = command == OperatorCommand::Reset && !now.button_pressed;
  if (command == OperatorCommand::EStop) return SupervisorState::Emergency;
  if (state == SupervisorState::Emergency) return reset ? SupervisorState::Idle : state;
  const bool allowed = state != SupervisorState::Idle && state != SupervisorState::Stopped;
  if (allowed && fault) return SupervisorState::Stopped;
  if (allowed && command == OperatorCommand::Stop) return SupervisorState::Idle;
  if (allowed) return expected_while_allowed(state, conditions, now.may_search);
  if (state == SupervisorState::Stopped && reset) return SupervisorState::Idle;
  const bool by_itself =
      now.at_once && (state == SupervisorState::Stopped ? command != OperatorCommand::Stop
                                                        : command == OperatorCommand::None);
  if (fault || !(by_itself || command == OperatorCommand::Start)) return state;
  return expected_while_allowed(SupervisorState::Armed, conditions, now.may_search);
}

/// The cause of the change that led to `after`.
inline TransitionCause expected_cause(SupervisorState before, SupervisorState after, Conditions conditions,
                                      OperatorCommand command) {
  switch (after) {
    case SupervisorState::Emergency:
      return TransitionCause::EStop;
    case SupervisorState::Idle:
      return command == OperatorCommand::Stop ? TransitionCause::Stop : TransitionCause::Reset;
    case SupervisorState::Following:
      return TransitionCause::TargetGood;
    case SupervisorState::Searching:
      return TransitionCause::TargetLost;
    case SupervisorState::Armed:
      return command == OperatorCommand::Start    ? TransitionCause::Start
             : before == SupervisorState::Stopped ? TransitionCause::FaultGone
                                                  : TransitionCause::StartAtOnce;
    case SupervisorState::Waiting:
      if (before == SupervisorState::Searching && (conditions & kSensesBits) == 0)
        return TransitionCause::SearchEnded;
      break;
    case SupervisorState::Stopped:
      break;
  }
  return first_condition(conditions)->cause;
}

}  // namespace heel::test
