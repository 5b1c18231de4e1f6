#include "sim/robot/robot_event.h"

#include <fmt/format.h>

#include "sim/robot/fault.h"

namespace heel::sim {

std::string describe(const RobotEvent& event) {
  switch (event.kind) {
    case RobotEventKind::Synced:
      return "synced";
    case RobotEventKind::Opened:
      return "opened";
    case RobotEventKind::Closed:
      return "closed";
    case RobotEventKind::Enabled:
      return "enabled";
    case RobotEventKind::Disabled:
      return "disabled";
    case RobotEventKind::StopButton:
      return "stop button pressed, motors off";
    case RobotEventKind::StopButtonFree:
      return "stop button released, motors stay off";
    case RobotEventKind::EnableRefused:
      return "enable refused: stop button held";
    case RobotEventKind::WatchdogStop:
      return "watchdog stop";
    case RobotEventKind::WatchdogResume:
      return event.value != 0 ? "watchdog over, the old motion continues" : "watchdog over";
    case RobotEventKind::Bumpers:
      return fmt::format("bumpers front {} rear {}", event.value & 0x7F, event.value >> 8 & 0x7F);
    case RobotEventKind::Stalled:
      return "stalled";
    case RobotEventKind::StallOver:
      return "stall over";
    case RobotEventKind::BaudChanged:
      return fmt::format("baud {}", event.value);
    case RobotEventKind::Reset:
      return fmt::format("controller reset, notice {}", event.value);
    case RobotEventKind::Maintenance:
      return "maintenance mode: no communication until reset";
    case RobotEventKind::FaultBegins:
      return fmt::format("fault {}", to_string(static_cast<FaultKind>(event.value)));
  }
  return "?";
}

}  // namespace heel::sim
