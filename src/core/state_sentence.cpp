#include "core/state_sentence.h"

#include <array>
#include <cstdio>

#include "core/robot_name.h"

namespace heel {
namespace {

std::string with_metres(const char* before, double distance_m, const char* after) {
  std::array<char, 80> text{};
  const int size = std::snprintf(text.data(), text.size(), "%s%.2f m%s", before, distance_m, after);
  return {text.data(), static_cast<std::size_t>(size)};
}

/// What the gate holds the robot by; empty: nothing.
std::string hold_sentence(const TickRecord& tick) {
  switch (tick.hold) {
    case Hold::PersonTooNear:
      return with_metres("held: the person is ", tick.person_m, " away");
    case Hold::ObstacleAhead:
      return with_metres("held: ", tick.free_distance_m, " to an echo ahead");
    case Hold::None:
      break;
  }
  return "";
}

std::string moving_sentence(const TickRecord& tick) {
  if (tick.hold != Hold::None) return hold_sentence(tick);
  const std::uint32_t template_index = tick.input.pose.template_index;
  return template_index == 0 ? "following" : "following by template " + std::to_string(template_index);
}

/// What is left to do, so that the robot may move.
const char* remedy(const TickRecord& tick) {
  switch (tick.stop_reason) {
    case StopReason::StopButton:
      return "; release it, then `heel reset`";
    case StopReason::MotorsOff:
    case StopReason::EmergencyStop:
      return "; `heel reset`, then `heel start`";
    case StopReason::TurnsAway:
      return "; check camera.rotate, camera.mirror and the mount, and the cables of wheels and gyro; then "
             "`heel reset`";
    case StopReason::NotStarted:
      return "; `heel start` lets the robot move";
    case StopReason::Shutdown:
      return "";
    default:
      return tick.state == SupervisorState::Stopped && tick.needs_start ? "; when it is over, `heel start`"
                                                                        : "";
  }
}

std::string shown_name(const std::string& name) {
  return is_plain_name(name) ? name : "'" + name + "'";
}

/// Why the robot that answers is not driven, and what to do; empty: it is not refused.
std::string refusal(const RobotKind& robot) {
  const std::string subclass = shown_name(robot.subclass.data());
  switch (robot.choice) {
    case ModelChoice::Unknown:
      return "the robot is not driven: heeld does not know class " + shown_name(robot.robot_class.data()) +
             ", subclass " + subclass;
    case ModelChoice::Conflict:
      return "the robot is not driven: it is a " + subclass + ", and robot.model says otherwise";
    case ModelChoice::Nameless:
      return "the robot is not driven: it does not say what it is; set robot.model";
    case ModelChoice::NotYet:
    case ModelChoice::Chosen:
      break;
  }
  return "";
}

std::string sentence_of_state(const TickRecord& tick) {
  if (tick.stop_reason == StopReason::None) return moving_sentence(tick);
  const std::string reason = to_string(tick.stop_reason);
  if (tick.state == SupervisorState::Searching)
    return "searching: " + reason + (tick.hold == Hold::None ? "" : "; " + hold_sentence(tick));
  if (tick.stop_reason == StopReason::LinkDown && tick.input.robot.phase == LinkPhase::Refused)
    return "at rest: " + refusal(tick.input.robot.kind);
  const PoseEstimate& pose = tick.input.pose;
  const bool waits_for_person =
      tick.stop_reason == StopReason::NoTargetYet || tick.stop_reason == StopReason::TargetLost;
  if (waits_for_person && tick.input.has_pose && !pose.found())
    return "at rest: " + reason + " (" + to_string(pose.reason) + ")";
  return "at rest: " + reason + remedy(tick);
}

/// Whether the reason to rest is that nobody is found.
bool lacks_person(const TickRecord& tick) {
  switch (tick.stop_reason) {
    case StopReason::NoTargetYet:
    case StopReason::TargetLost:
    case StopReason::LowCertainty:
    case StopReason::NotStarted:
      return tick.input.has_pose && !tick.input.pose.found();
    default:
      return false;
  }
}

}  // namespace

std::string picture_sentence(PictureFault fault) {
  switch (fault) {
    case PictureFault::None:
      break;
    case PictureFault::Dark:
      return "the picture is dark: is the lens covered, or the light off?";
    case PictureFault::TooBright:
      return "the picture is too bright: does a light shine into the lens, or is the exposure set too long?";
    case PictureFault::NoDetail:
      return "the picture shows no detail: does something cover the lens, or a bare wall fill the view?";
    case PictureFault::OutOfFocus:
      return "the picture is out of focus: turn the lens, or clean it";
    case PictureFault::Interlaced:
      return "the picture has rows of two times: set the camera to progressive";
    case PictureFault::Flicker:
      return "the light flickers: set the camera's power line frequency to that of the mains";
    case PictureFault::ExposureHunting:
      return "the brightness goes up and down: set the exposure by hand";
  }
  return "";
}

std::string state_sentence(const TickRecord& tick) {
  const std::string advice = lacks_person(tick) ? picture_sentence(tick.input.pose.picture) : "";
  return sentence_of_state(tick) + (advice.empty() ? "" : "; " + advice);
}

}  // namespace heel
