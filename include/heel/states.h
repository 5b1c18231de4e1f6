/// \file
/// The names of what supervisor and gate decide: conditions, states, the causes of their changes, the reasons
/// to rest, and the gate's limits. heel/flow.h has the structs that carry them.
///
/// - Convention: conditions and limits are bits; docs/safety.md shows the tables of conditions and states.
/// - Errors: to_string() of a value that has no name is "?".
#pragma once

#include <cstddef>
#include <cstdint>

namespace heel {

/// The conditions that keep the robot at rest, as bits of Conditions.
enum Condition : std::uint32_t {
  kShutdown = 1 << 0,
  kLinkDown = 1 << 1,
  kStaleSip = 1 << 2,  ///< no packet from the robot for the timeout
  kStopButton = 1 << 3,
  kMotorsOff = 1 << 4,
  kBumper = 1 << 5,         ///< pressed, or released less than the hold time ago
  kStall = 1 << 6,          ///< wheels stalled, or free again for less than the hold time
  kSonarSilent = 1 << 7,    ///< no reading from any front sonar for the timeout, though they are on
  kStaleFrame = 1 << 8,     ///< no frame for the timeout, or none yet
  kLowCertainty = 1 << 9,   ///< not following; the shirt is found, but with too little certainty
  kTargetLost = 1 << 10,    ///< not following, having followed before
  kNoTargetYet = 1 << 11,   ///< not following, never followed
  kAmbiguous = 1 << 12,     ///< not following; the newest frame shows the shirt at two places
  kBatteryLow = 1 << 13,    ///< below the lower voltage, and since then not above the upper one
  kOverrun = 1 << 14,       ///< the tick came too many periods late
  kClockStep = 1 << 15,     ///< the time went back, or ahead by more than the lateness explains
  kOperatorAway = 1 << 16,  ///< no sign of the operator for the timeout
  kTurnsAway = 1 << 17,     ///< turning towards the person makes their bearing grow
};
/// Condition bits.
using Conditions = std::uint32_t;
inline constexpr Conditions kAllConditions = (1 << 18) - 1;

/// Where the supervisor stands. The robot moves only in Following and Searching.
enum class SupervisorState : std::uint8_t {
  Idle,       ///< not allowed to move: an operator's start is needed
  Armed,      ///< allowed to move; no target accepted since the start
  Following,  ///< the control law drives
  Searching,  ///< the target is lost, and the control law drives on
  Waiting,    ///< at rest; goes on by itself when the target is good
  Stopped,    ///< at rest after a fault: an operator's start is needed, after motors off a reset before it
  Emergency,  ///< at rest; only an operator's reset leaves it
};
inline constexpr std::size_t kSupervisorStates = 7;

/// Why the supervisor's state changed.
enum class TransitionCause : std::uint8_t {
  Boot,  ///< no change yet
  // The operator:
  Start,
  Stop,
  EStop,
  Reset,
  // supervisor.start = "at_once":
  StartAtOnce,
  FaultGone,
  // The target:
  TargetGood,
  TargetLost,
  SearchEnded,
  // Conditions, each named like its bit:
  Shutdown,
  LinkDown,
  StaleSip,
  StopButton,
  MotorsOff,
  Bumper,
  Stall,
  BatteryLow,
  Overrun,
  ClockStep,
  OperatorAway,
  TurnsAway,
  SonarSilent,
  StaleFrame,
  Ambiguous,
  LowCertainty,
};
inline constexpr std::size_t kTransitionCauses = 26;

/// Why the robot does not follow. Most are conditions of the supervisor's table; None: following.
enum class StopReason : std::uint8_t {
  None,
  Shutdown,
  LinkDown,
  StaleSip,
  StopButton,
  MotorsOff,
  Bumper,
  Stall,
  SonarSilent,
  NoTargetYet,
  StaleFrame,
  TargetLost,
  LowCertainty,
  Ambiguous,
  BatteryLow,
  Overrun,
  ClockStep,
  OperatorAway,
  TurnsAway,
  NotStarted,     ///< no condition: the operator's start is missing
  EmergencyStop,  ///< the operator's reset is missing
};

/// What the gate holds the robot by while the supervisor lets it move.
enum class Hold : std::uint8_t {
  None,
  PersonTooNear,  ///< TickRecord::person_m
  ObstacleAhead,  ///< TickRecord::free_distance_m
};

/// What is wrong with the camera's pictures, as far as they tell by themselves. It keeps nothing at rest; it
/// says why nothing is found.
enum class PictureFault : std::uint8_t {
  None,
  Dark,             ///< a cap on the lens, or no light
  TooBright,        ///< exposure far too long, or light straight into the lens
  NoDetail,         ///< a hand on the lens, or a bare wall that fills the picture
  OutOfFocus,       ///< no sharp edge for seconds
  Interlaced,       ///< rows of two times in one picture
  Flicker,          ///< bands of light that move over the picture
  ExposureHunting,  ///< the brightness goes up and down
};
inline constexpr std::size_t kPictureFaults = 8;

/// The gate's limits that changed a command, as bits of VelocityCommand::limited_by.
enum GateLimit : std::uint8_t {
  kGateSpeed = 1,
  kGateAcceleration = 2,
  kGateAge = 4,
  kGateNotFinite = 8,
  kGateSeparation = 16,  ///< the person is too near
  kGateObstacle = 32,    ///< a sonar obstacle is in the way
};

/// As people read them in logs, records and status lines.
const char* to_string(SupervisorState state);
const char* to_string(TransitionCause cause);
const char* to_string(StopReason reason);
const char* to_string(Hold hold);
const char* to_string(PictureFault fault);

}  // namespace heel
