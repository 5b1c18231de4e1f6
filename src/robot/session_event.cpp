// See session_event.h.
#include "robot/session_event.h"

namespace heel {

const char* to_string(SessionEventKind kind) {
  switch (kind) {
    case SessionEventKind::LineOpened:
      return "robot line opened";
    case SessionEventKind::LineLost:
      return "robot line lost";
    case SessionEventKind::TryingBaud:
      return "robot: trying baud";
    case SessionEventKind::FoundOpen:
      return "robot was left open by an earlier session: closing it";
    case SessionEventKind::NoAnswer:
      return "robot does not answer at baud";
    case SessionEventKind::Synchronised:
      return "robot synchronised";
    case SessionEventKind::ConfigReceived:
      return "robot sent its configuration; watchdog in ms";
    case SessionEventKind::ConfigMissing:
      return "robot sent no valid configuration: going on with the configured limits";
    case SessionEventKind::FirstSip:
      return "robot sends its information packets";
    case SessionEventKind::RateRaised:
      return "robot and line changed to baud";
    case SessionEventKind::RateRefused:
      return "robot is not heard at the rate it was asked for, going back; baud";
    case SessionEventKind::MotorsEnabled:
      return "motors enabled";
    case SessionEventKind::EnableRepeated:
      return "motors not yet enabled: asking again, attempt";
    case SessionEventKind::EnableFailed:
      return "motors do not enable: is a stop button pressed, the battery low? attempts";
    case SessionEventKind::StopButton:
      return "stop button or E-stall: motors stay off until heeld is restarted";
    case SessionEventKind::MotorsOff:
      return "motors went off: they stay off until heeld is restarted";
    case SessionEventKind::ControllerReset:
      return "robot controller has reset: connecting anew";
    case SessionEventKind::SipSilence:
      return "robot silent: connecting anew; ms without a packet";
    case SessionEventKind::OdometryRebased:
      return "robot's odometry began anew: the pose goes on from the last one";
    case SessionEventKind::OdometrySuspect:
      return "robot's odometry jumped farther than it can drive: left aside";
    case SessionEventKind::BadPacket:
      return "packet with a valid checksum but a broken layout; id";
    case SessionEventKind::Closed:
      return "robot session closed";
  }
  return "?";
}

bool is_warning(SessionEventKind kind) {
  switch (kind) {
    case SessionEventKind::LineLost:
    case SessionEventKind::NoAnswer:
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
