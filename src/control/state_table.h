// The supervisor's states as a table: in each state, what leads to which other state. Pure: no time, no
// memory. docs/safety.md shows the same table (control/state_manual.h prints it).
#pragma once

#include <span>

#include "control/condition_table.h"
#include "heel/flow.h"

namespace heel {

/// What may change the state. Several may hold in a tick: the first row of the state that applies counts.
enum class Trigger : std::uint8_t {
  EStop,
  Fault,
  Stop,
  Reset,
  Start,
  StartAtOnce,
  FaultGone,
  SensesMissing,
  TargetLostSearch,
  TargetLost,
  SearchEnded,
  TargetGood,
};
inline constexpr std::size_t kTriggers = 12;

/// What the table reads in a tick.
struct SupervisorFacts {
  Conditions conditions = 0;
  OperatorCommand command = OperatorCommand::None;  ///< of a request that is new in this tick
  bool button_pressed = false;                      ///< the robot's STOP button, now
  bool first_start = false;                         ///< no start has been made, and none is needed
  bool resumes = false;                             ///< needs no operator after a fault
  bool may_search = false;                          ///< the law can drive on without the target
};

struct StateRow {
  SupervisorState from;
  Trigger trigger;
  SupervisorState to;
};

inline constexpr StateRow kStateTable[] = {
    {SupervisorState::Idle, Trigger::EStop, SupervisorState::Emergency},
    {SupervisorState::Idle, Trigger::Start, SupervisorState::Armed},
    {SupervisorState::Idle, Trigger::StartAtOnce, SupervisorState::Armed},

    {SupervisorState::Armed, Trigger::EStop, SupervisorState::Emergency},
    {SupervisorState::Armed, Trigger::Fault, SupervisorState::Stopped},
    {SupervisorState::Armed, Trigger::Stop, SupervisorState::Idle},
    {SupervisorState::Armed, Trigger::TargetGood, SupervisorState::Following},

    {SupervisorState::Following, Trigger::EStop, SupervisorState::Emergency},
    {SupervisorState::Following, Trigger::Fault, SupervisorState::Stopped},
    {SupervisorState::Following, Trigger::Stop, SupervisorState::Idle},
    {SupervisorState::Following, Trigger::SensesMissing, SupervisorState::Waiting},
    {SupervisorState::Following, Trigger::TargetLostSearch, SupervisorState::Searching},
    {SupervisorState::Following, Trigger::TargetLost, SupervisorState::Waiting},

    {SupervisorState::Searching, Trigger::EStop, SupervisorState::Emergency},
    {SupervisorState::Searching, Trigger::Fault, SupervisorState::Stopped},
    {SupervisorState::Searching, Trigger::Stop, SupervisorState::Idle},
    {SupervisorState::Searching, Trigger::SensesMissing, SupervisorState::Waiting},
    {SupervisorState::Searching, Trigger::TargetGood, SupervisorState::Following},
    {SupervisorState::Searching, Trigger::SearchEnded, SupervisorState::Waiting},

    {SupervisorState::Waiting, Trigger::EStop, SupervisorState::Emergency},
    {SupervisorState::Waiting, Trigger::Fault, SupervisorState::Stopped},
    {SupervisorState::Waiting, Trigger::Stop, SupervisorState::Idle},
    {SupervisorState::Waiting, Trigger::TargetGood, SupervisorState::Following},

    {SupervisorState::Stopped, Trigger::EStop, SupervisorState::Emergency},
    {SupervisorState::Stopped, Trigger::Reset, SupervisorState::Idle},
    {SupervisorState::Stopped, Trigger::Start, SupervisorState::Armed},
    {SupervisorState::Stopped, Trigger::FaultGone, SupervisorState::Armed},

    {SupervisorState::Emergency, Trigger::Reset, SupervisorState::Idle},
};

/// Whether a trigger holds.
constexpr bool holds(Trigger trigger, const SupervisorFacts& facts) {
  const bool fault = (facts.conditions & kFaults) != 0;
  const bool senses_missing = (facts.conditions & kSensesMissing) != 0;
  const bool target_missing = (facts.conditions & kTargetMissing) != 0;
  switch (trigger) {
    case Trigger::EStop:
      return facts.command == OperatorCommand::EStop;
    case Trigger::Fault:
      return fault;
    case Trigger::Stop:
      return facts.command == OperatorCommand::Stop;
    case Trigger::Reset:
      return facts.command == OperatorCommand::Reset && !facts.button_pressed;
    case Trigger::Start:
      return facts.command == OperatorCommand::Start && !fault;
    case Trigger::StartAtOnce:
      return facts.first_start && !fault;
    case Trigger::FaultGone:
      return facts.resumes && !fault;
    case Trigger::SensesMissing:
      return senses_missing;
    case Trigger::TargetLostSearch:
      return target_missing && facts.may_search;
    case Trigger::TargetLost:
      return target_missing;
    case Trigger::SearchEnded:
      return !facts.may_search;
    case Trigger::TargetGood:
      return !senses_missing && !target_missing;
  }
  return false;
}

/// The first row of `state` that applies; null: the state stays.
constexpr const StateRow* next_row(SupervisorState state, const SupervisorFacts& facts,
                                   std::span<const StateRow> table = kStateTable) {
  for (const StateRow& row : table) {
    if (row.from == state && holds(row.trigger, facts)) return &row;
  }
  return nullptr;
}

/// The cause that is recorded when `trigger` has led to another state: of a group of conditions the first.
TransitionCause cause_of(Trigger trigger, Conditions conditions);

/// How the robot stops in a state. A fault stops it at once in each.
constexpr StopStyle style_of(SupervisorState state) {
  switch (state) {
    case SupervisorState::Following:
    case SupervisorState::Searching:
      return StopStyle::Go;
    case SupervisorState::Idle:
    case SupervisorState::Armed:
    case SupervisorState::Waiting:
      return StopStyle::ComeToRest;
    case SupervisorState::Stopped:
    case SupervisorState::Emergency:
      break;
  }
  return StopStyle::AtOnce;
}

}  // namespace heel
