// Events of the simulated robot, one line each, for logs and tests.
#pragma once

#include <cstdint>
#include <string>

#include "heel/time.h"

namespace heel::sim {

enum class RobotEventKind : std::uint8_t {
  Synced,
  Opened,
  Closed,
  Enabled,
  Disabled,        ///< by ENABLE 0
  StopButton,      ///< pressed: motors off
  StopButtonFree,  ///< released: motors stay off
  EnableRefused,   ///< ENABLE 1 while the STOP button is held
  WatchdogStop,    ///< no command during the watchdog's time
  WatchdogResume,  ///< the first command after a watchdog stop; value 1: the old motion continues
  Bumpers,         ///< value: front bits 0…6, rear bits 8…14
  Stalled,
  StallOver,
  BaudChanged,  ///< value: the new rate
  Reset,        ///< value: id of the notice
  Maintenance,  ///< packet 255 was received
  FaultBegins,  ///< value: its FaultKind
};

struct RobotEvent {
  TimeNs t_ns = 0;
  RobotEventKind kind = RobotEventKind::Synced;
  int value = 0;
};

/// "watchdog stop", or with its value "baud 38400".
std::string describe(const RobotEvent& event);

}  // namespace heel::sim
