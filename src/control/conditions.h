// What may keep the robot at rest, as bits, and the little memory they need: hysteresis and hold times.
#pragma once

#include <cstdint>

#include "control/control_stage.h"
#include "core/config.h"

namespace heel {

enum Condition : std::uint16_t {
  kShutdown = 1 << 0,
  kLinkDown = 1 << 1,
  kStaleSip = 1 << 2,
  kStopButton = 1 << 3,
  kMotorsOff = 1 << 4,
  kBumper = 1 << 5,        ///< pressed, or released less than the hold time ago
  kStall = 1 << 6,         ///< likewise
  kSonarSilent = 1 << 7,   ///< no word from any front sonar for the timeout, though they are on
  kStaleFrame = 1 << 8,    ///< no frame for the timeout, or none yet
  kLowCertainty = 1 << 9,  ///< not following, and the shirt is seen but not surely enough
  kTargetLost = 1 << 10,   ///< not following, having followed before
  kNoTargetYet = 1 << 11,  ///< not following, never followed
};
using Conditions = std::uint16_t;
inline constexpr Conditions kAllConditions = (1 << 12) - 1;

/// What happened to the newest pose this tick.
enum class MeasurementStatus : std::uint8_t {
  None,      ///< no new frame
  Accepted,  ///< the estimator took it
  Rejected,  ///< not found, or an outlier
};

/// Turns inputs into conditions. Following starts after `frames_to_follow` believed frames in a row at
/// `certainty_follow`, goes on while believed frames at `certainty_drop` come, and ends when none has come
/// for `target_timeout_s`.
class ConditionMonitor {
 public:
  /// `sonar_on`: whether their silence is a fault.
  Conditions observe(const ControlInput& input, MeasurementStatus news, const SupervisorConfig& config,
                     bool sonar_on);

 private:
  void observe_target(const ControlInput& input, MeasurementStatus news, const SupervisorConfig& config);

  bool following_ = false;
  bool ever_followed_ = false;
  int good_in_a_row_ = 0;
  TimeNs t_last_good_ns_ = 0;
  bool bumped_ = false;  // ever: the hold time counts from the last touch
  TimeNs t_last_bump_ns_ = 0;
  bool stalled_ = false;
  TimeNs t_last_stall_ns_ = 0;
};

}  // namespace heel
