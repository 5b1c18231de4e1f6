#include "robot/session_event.h"

namespace heel {

const char* to_string(SessionEventKind kind) {
  switch (kind) {
    case SessionEventKind::LineOpened:
      return "robot line opened";
    case SessionEventKind::LineLost:
      return "robot line lost; heeld connects again";
    case SessionEventKind::LineEnded:
      return "robot line ended before a robot answered; heeld connects again";
    case SessionEventKind::TryingBaud:
      return "trying the robot at {} baud";
    case SessionEventKind::FoundOpen:
      return "robot has a session open from earlier; closing it";
    case SessionEventKind::NoAnswer:
      return "robot does not answer at any rate from 9600 to 115200 baud; check that it is switched on, and "
             "that this is its cable";
    case SessionEventKind::NoAnswerTcp:
      return "robot does not answer; check that it is switched on, and that the port of robot.address is its "
             "line's";
    case SessionEventKind::OtherDevice:
      return "robot line answers, but not in ARCOS: text such as '{text}'; check that robot.address is the "
             "robot's";
    case SessionEventKind::LineEchoes:
      return "robot line echoes what heeld sends: a loop-back plug or local echo, no robot; check that "
             "robot.address is the robot's, and its cable";
    case SessionEventKind::OtherBytes:
      return "robot line answers, but not in ARCOS: {} bytes came; check that robot.address is "
             "the robot's, and its cable";
    case SessionEventKind::Synchronised:
      return "robot synchronised: class {class}, subclass {subclass}; driven as {model}";
    case SessionEventKind::ModelUnknown:
      return "robot is not driven: it is of class {class}, subclass {subclass}, which heeld does not know; "
             "docs/hardware.md lists the robots that it knows";
    case SessionEventKind::ModelConflict:
      return "robot is not driven: it is a {subclass}, and robot.model is {model}; set robot.model = "
             "\"auto\", or connect the {model}";
    case SessionEventKind::ModelMissing:
      return "robot is not driven: it does not say what it is; set robot.model to its subclass "
             "(docs/hardware.md)";
    case SessionEventKind::ConfigReceived:
      return "robot sent its configuration; its watchdog time is {} ms";
    case SessionEventKind::ConfigMissing:
      return "robot sent no valid configuration: its limits are unknown, stops are planned with 300 mm/s²";
    case SessionEventKind::BrakesLimited:
      return "robot's controller brakes with {} mm/s² at most, less than robot.deceleration_mm_s2: speeds "
             "near people "
             "and obstacles are lower";
    case SessionEventKind::FirstSip:
      return "robot sends information packets (SIP)";
    case SessionEventKind::RateRaised:
      return "robot and line changed to {} baud";
    case SessionEventKind::RateRefused:
      return "robot did not change to {} baud; the old rate stays";
    case SessionEventKind::MotorsEnabled:
      return "motors enabled";
    case SessionEventKind::EnableRepeated:
      return "motors are not enabled yet; attempt {} to enable them";
    case SessionEventKind::EnableFailed:
      return "motors are not enabled after {} attempts; check stop button and battery, then `heel reset`";
    case SessionEventKind::EnableAgain:
      return "reset by the operator: enabling the motors again";
    case SessionEventKind::StopButton:
      return "stop button or E-stall: motors stay off until `heel reset`";
    case SessionEventKind::MotorsOff:
      return "motors went off: they stay off until `heel reset`";
    case SessionEventKind::ControllerReset:
      return "robot controller was reset; heeld connects again";
    case SessionEventKind::SipSilence:
      return "no packet from the robot for {} ms; heeld connects again";
    case SessionEventKind::OdometryRebased:
      return "robot's odometry counters restarted; the pose continues from the last one";
    case SessionEventKind::OdometrySuspect:
      return "robot's odometry jumped farther than the robot can drive; packet ignored";
    case SessionEventKind::BadPacket:
      return "packet {} has a valid checksum and a wrong layout; ignored";
    case SessionEventKind::Closed:
      return "robot session closed";
  }
  return "?";
}

bool is_warning(SessionEventKind kind) {
  switch (kind) {
    case SessionEventKind::LineLost:
    case SessionEventKind::LineEnded:
    case SessionEventKind::NoAnswer:
    case SessionEventKind::NoAnswerTcp:
    case SessionEventKind::OtherDevice:
    case SessionEventKind::LineEchoes:
    case SessionEventKind::OtherBytes:
    case SessionEventKind::ModelUnknown:
    case SessionEventKind::ModelConflict:
    case SessionEventKind::ModelMissing:
    case SessionEventKind::ConfigMissing:
    case SessionEventKind::BrakesLimited:
    case SessionEventKind::RateRefused:
    case SessionEventKind::EnableFailed:
    case SessionEventKind::StopButton:
    case SessionEventKind::MotorsOff:
    case SessionEventKind::ControllerReset:
    case SessionEventKind::SipSilence:
    case SessionEventKind::OdometryRebased:
    case SessionEventKind::OdometrySuspect:
    case SessionEventKind::BadPacket:
      return true;
    default:
      return false;
  }
}

}  // namespace heel
