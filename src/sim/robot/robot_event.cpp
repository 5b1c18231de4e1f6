#include "sim/robot/robot_event.h"

#include "sim/robot/fault.h"

namespace heel::sim {

std::string describe(const RobotEvent& event) {
  const std::string value = std::to_string(event.value);
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
      return event.value != 0 ? "watchdog over, the old motion resumes" : "watchdog over";
    case RobotEventKind::Bumpers:
      return "bumpers front " + std::to_string(event.value & 0x7F) + " rear " +
             std::to_string(event.value >> 8 & 0x7F);
    case RobotEventKind::Stalled:
      return "stalled";
    case RobotEventKind::StallOver:
      return "stall over";
    case RobotEventKind::BaudChanged:
      return "baud " + value;
    case RobotEventKind::Reset:
      return "controller reset, notice " + value;
    case RobotEventKind::Maintenance:
      return "maintenance mode: deaf until reset";
    case RobotEventKind::FaultBegins:
      return std::string("fault ") + to_string(static_cast<FaultKind>(event.value));
  }
  return "?";
}

}  // namespace heel::sim
