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
