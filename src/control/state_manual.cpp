#include "control/state_manual.h"

#include <initializer_list>

#include "control/state_table.h"

namespace heel {
namespace {

constexpr const char* kRule = "In each state the first row that applies counts.";
constexpr const char* kPriority =
    "Of several conditions the first is reported. While one that is a fault holds, zero is commanded at once "
    "in "
    "each state, and `start` is refused.";

const char* meaning_of(SupervisorState state) {
  switch (state) {
    case SupervisorState::Idle:
      return "not allowed to move; heeld starts in this state";
    case SupervisorState::Armed:
      return "allowed to move; no target accepted since the start";
    case SupervisorState::Following:
      return "the control law drives";
    case SupervisorState::Searching:
      return "the target is lost; the control law drives on along what it knows of the path";
    case SupervisorState::Waiting:
      return "goes on by itself when the target is good and nothing is missing";
    case SupervisorState::Stopped:
      return "a fault has stopped the robot";
    case SupervisorState::Emergency:
      return "an operator has given `estop`";
  }
  return "?";
}

const char* text_of(StopStyle style) {
  switch (style) {
    case StopStyle::Go:
      return "may move";
    case StopStyle::ComeToRest:
      return "comes to rest with `gate.deceleration_m_s2`";
    case StopStyle::AtOnce:
      break;
  }
  return "zero is commanded at once";
}

const char* text_of(Trigger trigger) {
  switch (trigger) {
    case Trigger::EStop:
      return "`estop`";
    case Trigger::Fault:
      return "a fault";
    case Trigger::Stop:
      return "`stop`";
    case Trigger::Reset:
      return "`reset`, and the STOP button is not pressed";
    case Trigger::Start:
      return "`start`, and there is no fault";
    case Trigger::StartAtOnce:
      return "no fault, with `supervisor.start = \"at_once\"`, once after heeld has started";
    case Trigger::FaultGone:
      return "no fault any more, with `supervisor.start = \"at_once\"` and no `stop` since the last `start`";
    case Trigger::SensesMissing:
      return "sensor data are missing";
    case Trigger::TargetLostSearch:
      return "the target is lost, and the law can drive on without it";
    case Trigger::TargetLost:
      return "the target is lost";
    case Trigger::SearchEnded:
      return "the law has come to the end of what it knows, or after `supervisor.search_s`";
    case Trigger::TargetGood:
      return "the target is good, and no sensor data are missing";
  }
  return "?";
}

const char* text_of(ConditionKind kind) {
  switch (kind) {
    case ConditionKind::Fault:
      return "fault";
    case ConditionKind::SensesMissing:
      return "sensor data are missing";
    case ConditionKind::TargetMissing:
      break;
  }
  return "the target is lost";
}

std::string row_of(std::initializer_list<std::string> cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + cell + " |";
  return row + "\n";
}

std::string name_of(SupervisorState state) {
  return std::string("**") + to_string(state) + "**";
}

}  // namespace

std::string state_manual_text() {
  std::string text = "| state | meaning | the robot |\n|---|---|---|\n";
  for (std::size_t i = 0; i < kSupervisorStates; ++i) {
    const auto state = static_cast<SupervisorState>(i);
    text += row_of({name_of(state), meaning_of(state), text_of(style_of(state))});
  }
  text += "\n" + std::string(kRule) + "\n\n| in state | when | next state |\n|---|---|---|\n";
  for (const StateRow& row : kStateTable)
    text += row_of({name_of(row.from), text_of(row.trigger), name_of(row.to)});
  text += "\n" + std::string(kPriority) + "\n\n";
  text += "| condition | holds when | counts as | noticed within |\n|---|---|---|---|\n";
  for (const ConditionRow& row : kConditionTable)
    text += row_of({to_string(row.reason), row.when, text_of(row.kind), row.noticed_within});
  return text;
}

}  // namespace heel
