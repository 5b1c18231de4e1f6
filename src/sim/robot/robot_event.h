// What happens to the simulated robot, one line each, for logs and tests.
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
  WatchdogStop,    ///< no command for the watchdog's time
  WatchdogResume,  ///< a command came; value 1: it set the old motion going again
  Bumpers,         ///< value: front bits 0…6, rear bits 8…14
  Stalled,
  StallOver,
  BaudChanged,  ///< value: the new rate
  Reset,        ///< value: the notice's id
  Maintenance,  ///< 255 was sent
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
