// The table of conditions: for each the reason that is reported, the cause of the change of state, and how
// the robot stops. The first row that applies counts.
#pragma once

#include "heel/flow.h"

namespace heel {

enum class StopStyle : std::uint8_t {
  Go,          ///< not stopping
  ComeToRest,  ///< within the deceleration limits
  AtOnce,      ///< zero on the wire now; the robot's controller brakes
};

/// What a condition means for the supervisor.
enum class ConditionKind : std::uint8_t {
  Fault,          ///< latched in Stopped; only such a condition refuses a start
  SensesMissing,  ///< passes by itself
  TargetMissing,
};

struct ConditionRow {
  Condition condition;
  StopReason reason;
  TransitionCause cause;
  ConditionKind kind;
  const char* when;            ///< for the manual: when it holds …
  const char* noticed_within;  ///< … and how long after its cause at most
};

/// Highest priority first: shutdown; no knowledge of the robot; motors off; contact; time; battery and
/// operator; missing sensor data. The rows about the target go from the most to the least specific.
inline constexpr ConditionRow kConditionTable[] = {
    {kShutdown, StopReason::Shutdown, TransitionCause::Shutdown, ConditionKind::Fault, "heeld ends",
     "at once"},
    {kLinkDown, StopReason::LinkDown, TransitionCause::LinkDown, ConditionKind::Fault,
     "there is no session with the robot, or it is not complete", "the next tick, when the line breaks"},
    {kStaleSip, StopReason::StaleSip, TransitionCause::StaleSip, ConditionKind::Fault,
     "the robot has sent no packet for `supervisor.sip_timeout_s`", "`supervisor.sip_timeout_s`"},
    {kStopButton, StopReason::StopButton, TransitionCause::StopButton, ConditionKind::Fault,
     "the STOP button is pressed, or an E-stall is engaged", "0.1 s, the robot's next packet"},
    {kMotorsOff, StopReason::MotorsOff, TransitionCause::MotorsOff, ConditionKind::Fault,
     "the motors are off; when they went off by themselves: until a `reset`",
     "0.1 s, the robot's next packet"},
    {kBumper, StopReason::Bumper, TransitionCause::Bumper, ConditionKind::Fault,
     "a bumper is pressed, or was less than `supervisor.bumper_hold_s` ago",
     "0.1 s, the robot's next packet"},
    {kStall, StopReason::Stall, TransitionCause::Stall, ConditionKind::Fault,
     "a wheel is stalled, or was less than `supervisor.bumper_hold_s` ago", "0.1 s, the robot's next packet"},
    {kOverrun, StopReason::Overrun, TransitionCause::Overrun, ConditionKind::Fault,
     "the tick runs more than `supervisor.lateness_max_s` late", "in that tick"},
    {kClockStep, StopReason::ClockStep, TransitionCause::ClockStep, ConditionKind::Fault,
     "the clock went back, or ahead by 0.5 s more than the tick is late", "in that tick"},
    {kBatteryLow, StopReason::BatteryLow, TransitionCause::BatteryLow, ConditionKind::Fault,
     "the battery had less than `supervisor.battery_low_v` for 2 s, and `supervisor.battery_ok_v` not since",
     "2 s"},
    {kTurnsAway, StopReason::TurnsAway, TransitionCause::TurnsAway, ConditionKind::Fault,
     "the person's bearing grew while the robot turned towards them; until a `reset`. Not with a file as the "
     "camera",
     "0.5 s after the robot turns by 0.2 rad/s"},
    {kOperatorAway, StopReason::OperatorAway, TransitionCause::OperatorAway, ConditionKind::Fault,
     "no sign of the operator for `supervisor.operator_timeout_s`", "`supervisor.operator_timeout_s`"},
    {kSonarSilent, StopReason::SonarSilent, TransitionCause::SonarSilent, ConditionKind::SensesMissing,
     "no front sonar was read for `supervisor.sonar_timeout_s`, though they are on",
     "`supervisor.sonar_timeout_s`"},
    {kStaleFrame, StopReason::StaleFrame, TransitionCause::StaleFrame, ConditionKind::SensesMissing,
     "no picture for `supervisor.frame_timeout_s`", "`supervisor.frame_timeout_s`"},
    {kAmbiguous, StopReason::Ambiguous, TransitionCause::Ambiguous, ConditionKind::SensesMissing,
     "no target, and the newest picture shows the shirt at two places", "`supervisor.target_timeout_s`"},
    {kLowCertainty, StopReason::LowCertainty, TransitionCause::LowCertainty, ConditionKind::SensesMissing,
     "no target, and the shirt is found with less certainty than `supervisor.certainty_follow`",
     "`supervisor.target_timeout_s`"},
    {kTargetLost, StopReason::TargetLost, TransitionCause::TargetLost, ConditionKind::TargetMissing,
     "no good frame for `supervisor.target_timeout_s`", "`supervisor.target_timeout_s`"},
    {kNoTargetYet, StopReason::NoTargetYet, TransitionCause::TargetLost, ConditionKind::TargetMissing,
     "the shirt has not been found since heeld started", "at rest since the start"},
};

/// All conditions of a kind.
constexpr Conditions conditions_of(ConditionKind kind) {
  Conditions bits = 0;
  for (const ConditionRow& row : kConditionTable) bits |= row.kind == kind ? row.condition : 0U;
  return bits;
}
inline constexpr Conditions kFaults = conditions_of(ConditionKind::Fault);
inline constexpr Conditions kSensesMissing = conditions_of(ConditionKind::SensesMissing);
inline constexpr Conditions kTargetMissing = conditions_of(ConditionKind::TargetMissing);

/// The first row whose condition holds; null: none does.
constexpr const ConditionRow* first_condition(Conditions conditions) {
  for (const ConditionRow& row : kConditionTable) {
    if ((conditions & row.condition) != 0) return &row;
  }
  return nullptr;
}

}  // namespace heel
