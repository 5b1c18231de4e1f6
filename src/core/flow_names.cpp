// Names of the reasons and phases in heel/flow.h, as people read them in logs, records and status lines.
#include "heel/flow.h"

namespace heel {

const char* to_string(PoseReason reason) {
  switch (reason) {
    case PoseReason::Found:
      return "found";
    case PoseReason::TooFewFeatures:
      return "too few features";
    case PoseReason::TooFewMatches:
      return "too few matches";
    case PoseReason::NoHomography:
      return "no homography";
    case PoseReason::TooFewInliers:
      return "too few inliers";
    case PoseReason::ImplausibleShape:
      return "implausible shape";
    case PoseReason::NoValidMotion:
      return "no valid motion";
    case PoseReason::WrongFrameSize:
      return "wrong frame size";
    case PoseReason::PatchesDisagree:
      return "patches disagree";
    case PoseReason::OutOfReach:
      return "out of reach";
    case PoseReason::Ambiguous:
      return "ambiguous";
  }
  return "?";
}

const char* to_string(LinkPhase phase) {
  switch (phase) {
    case LinkPhase::Closed:
      return "closed";
    case LinkPhase::Syncing:
      return "syncing";
    case LinkPhase::Opening:
      return "opening";
    case LinkPhase::Enabling:
      return "enabling";
    case LinkPhase::Running:
      return "running";
    case LinkPhase::Disabled:
      return "disabled";
    case LinkPhase::Lost:
      return "lost";
    case LinkPhase::Refused:
      return "refused";
  }
  return "?";
}

const char* to_string(ModelChoice choice) {
  switch (choice) {
    case ModelChoice::NotYet:
      return "not yet";
    case ModelChoice::Chosen:
      return "chosen";
    case ModelChoice::Unknown:
      return "unknown";
    case ModelChoice::Conflict:
      return "conflict";
    case ModelChoice::Nameless:
      return "nameless";
  }
  return "?";
}

const char* to_string(MeasurementStatus status) {
  switch (status) {
    case MeasurementStatus::None:
      return "none";
    case MeasurementStatus::Accepted:
      return "accepted";
    case MeasurementStatus::NotFound:
      return "not found";
    case MeasurementStatus::Unusable:
      return "unusable";
    case MeasurementStatus::NoOdometry:
      return "no odometry";
    case MeasurementStatus::OutOfOrder:
      return "out of order";
    case MeasurementStatus::Outlier:
      return "outlier";
  }
  return "?";
}

const char* to_string(StopReason reason) {
  switch (reason) {
    case StopReason::None:
      return "following";
    case StopReason::Shutdown:
      return "shutting down";
    case StopReason::LinkDown:
      return "no link to the robot";
    case StopReason::StaleSip:
      return "robot silent";
    case StopReason::StopButton:
      return "stop button pressed";
    case StopReason::MotorsOff:
      return "motors off";
    case StopReason::Bumper:
      return "bumper pressed";
    case StopReason::Stall:
      return "wheels stalled";
    case StopReason::SonarSilent:
      return "sonars silent";
    case StopReason::NoTargetYet:
      return "no target seen yet";
    case StopReason::StaleFrame:
      return "camera silent";
    case StopReason::TargetLost:
      return "target lost";
    case StopReason::LowCertainty:
      return "certainty too low";
    case StopReason::Ambiguous:
      return "shirt seen at two places";
    case StopReason::BatteryLow:
      return "battery low";
    case StopReason::Overrun:
      return "control too late";
    case StopReason::ClockStep:
      return "clock jumped";
    case StopReason::TurnsAway:
      return "turning towards the person makes their bearing grow";
    case StopReason::OperatorAway:
      return "operator away";
    case StopReason::NotStarted:
      return "not started";
    case StopReason::EmergencyStop:
      return "emergency stop";
  }
  return "?";
}

const char* to_string(PictureFault fault) {
  switch (fault) {
    case PictureFault::None:
      return "none";
    case PictureFault::Dark:
      return "dark";
    case PictureFault::TooBright:
      return "too bright";
    case PictureFault::NoDetail:
      return "no detail";
    case PictureFault::OutOfFocus:
      return "out of focus";
    case PictureFault::Interlaced:
      return "interlaced";
    case PictureFault::Flicker:
      return "flicker";
    case PictureFault::ExposureHunting:
      return "exposure hunting";
  }
  return "?";
}

const char* to_string(Hold hold) {
  switch (hold) {
    case Hold::None:
      return "none";
    case Hold::PersonTooNear:
      return "person too near";
    case Hold::ObstacleAhead:
      return "obstacle ahead";
  }
  return "?";
}

const char* to_string(OperatorCommand command) {
  switch (command) {
    case OperatorCommand::None:
      return "none";
    case OperatorCommand::Start:
      return "start";
    case OperatorCommand::Stop:
      return "stop";
    case OperatorCommand::EStop:
      return "estop";
    case OperatorCommand::Reset:
      return "reset";
  }
  return "?";
}

const char* to_string(OperatorOutcome outcome) {
  switch (outcome) {
    case OperatorOutcome::None:
      return "none";
    case OperatorOutcome::Done:
      return "done";
    case OperatorOutcome::AlreadySo:
      return "already so";
    case OperatorOutcome::Refused:
      return "refused";
  }
  return "?";
}

const char* to_string(SupervisorState state) {
  switch (state) {
    case SupervisorState::Idle:
      return "idle";
    case SupervisorState::Armed:
      return "armed";
    case SupervisorState::Following:
      return "following";
    case SupervisorState::Searching:
      return "searching";
    case SupervisorState::Waiting:
      return "waiting";
    case SupervisorState::Stopped:
      return "stopped";
    case SupervisorState::Emergency:
      return "emergency";
  }
  return "?";
}

const char* to_string(TransitionCause cause) {
  switch (cause) {
    case TransitionCause::Boot:
      return "boot";
    case TransitionCause::Start:
      return "start by the operator";
    case TransitionCause::Stop:
      return "stop by the operator";
    case TransitionCause::EStop:
      return "emergency stop by the operator";
    case TransitionCause::Reset:
      return "reset by the operator";
    case TransitionCause::StartAtOnce:
      return "start at once";
    case TransitionCause::FaultGone:
      return "fault gone";
    case TransitionCause::TargetGood:
      return "target good";
    case TransitionCause::TargetLost:
      return to_string(StopReason::TargetLost);
    case TransitionCause::SearchEnded:
      return "search ended";
    case TransitionCause::Shutdown:
      return to_string(StopReason::Shutdown);
    case TransitionCause::LinkDown:
      return to_string(StopReason::LinkDown);
    case TransitionCause::StaleSip:
      return to_string(StopReason::StaleSip);
    case TransitionCause::StopButton:
      return to_string(StopReason::StopButton);
    case TransitionCause::MotorsOff:
      return to_string(StopReason::MotorsOff);
    case TransitionCause::Bumper:
      return to_string(StopReason::Bumper);
    case TransitionCause::Stall:
      return to_string(StopReason::Stall);
    case TransitionCause::BatteryLow:
      return to_string(StopReason::BatteryLow);
    case TransitionCause::Overrun:
      return to_string(StopReason::Overrun);
    case TransitionCause::ClockStep:
      return to_string(StopReason::ClockStep);
    case TransitionCause::TurnsAway:
      return to_string(StopReason::TurnsAway);
    case TransitionCause::OperatorAway:
      return to_string(StopReason::OperatorAway);
    case TransitionCause::SonarSilent:
      return to_string(StopReason::SonarSilent);
    case TransitionCause::StaleFrame:
      return to_string(StopReason::StaleFrame);
    case TransitionCause::Ambiguous:
      return to_string(StopReason::Ambiguous);
    case TransitionCause::LowCertainty:
      return to_string(StopReason::LowCertainty);
  }
  return "?";
}

const char* to_string(EventKind kind) {
  switch (kind) {
    case EventKind::CameraOpened:
      return "camera opened";
    case EventKind::CameraUnavailable:
      return "camera does not open";
    case EventKind::CameraLost:
      return "camera lost";
    case EventKind::CameraEnded:
      return "camera's stream ended";
    case EventKind::FrameRefused:
      return "frame refused";
    case EventKind::FrameCorrupt:
      return "frame corrupt";
    case EventKind::Overrun:
      return "deadline missed";
    case EventKind::Note:
      return "note";
    case EventKind::Warning:
      return "warning";
  }
  return "?";
}

}  // namespace heel
