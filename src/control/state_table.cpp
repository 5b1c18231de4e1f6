#include "control/state_table.h"

namespace heel {

TransitionCause cause_of(Trigger trigger, Conditions conditions) {
  switch (trigger) {
    case Trigger::EStop:
      return TransitionCause::EStop;
    case Trigger::Stop:
      return TransitionCause::Stop;
    case Trigger::Reset:
      return TransitionCause::Reset;
    case Trigger::Start:
      return TransitionCause::Start;
    case Trigger::StartAtOnce:
      return TransitionCause::StartAtOnce;
    case Trigger::FaultGone:
      return TransitionCause::FaultGone;
    case Trigger::SearchEnded:
      return TransitionCause::SearchEnded;
    case Trigger::TargetGood:
      return TransitionCause::TargetGood;
    case Trigger::Fault:
    case Trigger::SensesMissing:
    case Trigger::TargetLostSearch:
    case Trigger::TargetLost:
      break;
  }
  // A fault has the highest priority, then missing sensor data, then a missing target: the first condition is
  // of the trigger's group.
  return first_condition(conditions)->cause;
}

}  // namespace heel
