// Every configuration key, once: name, type (by the member it fills), unit, range, reload, effect.
#include "config/config_table.h"

#include <array>
#include <charconv>

namespace heel {
namespace {

// Names the key after the member it fills, so that the two cannot drift apart.
#define HEEL_KEY(section, name) #section, #name, [](Config & c) { return &c.section.name; }

using enum Reload;

struct Range {
  double min, max;
};

using Name = std::string_view;

constexpr ConfigKey number(Name section, Name name, double* (*field)(Config&), Name unit, Range range,
                           Reload reload, Name effect) {
  return {section, name, field, unit, range.min, range.max, ConfigText::Choice, "", reload, effect};
}
constexpr ConfigKey number(Name section, Name name, int* (*field)(Config&), Name unit, Range range,
                           Reload reload, Name effect) {
  return {section, name, field, unit, range.min, range.max, ConfigText::Choice, "", reload, effect};
}
constexpr ConfigKey flag(Name section, Name name, bool* (*field)(Config&), Reload reload, Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Choice, "", reload, effect};
}
constexpr ConfigKey choice(Name section, Name name, std::string* (*field)(Config&), Name choices,
                           Reload reload, Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Choice, choices, reload, effect};
}
constexpr ConfigKey path(Name section, Name name, std::string* (*field)(Config&), Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Path, "", No, effect};
}
constexpr ConfigKey address(Name section, Name name, std::string* (*field)(Config&), Name schemes,
                            Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Address, schemes, No, effect};
}

constexpr ConfigSection kSections[] = {
    {"camera", "The camera and where it sits on the robot."},
    {"target", "Whom to follow."},
    {"vision", "From a frame to the pose of the shirt."},
    {"estimate", "The person in the odometry frame."},
    {"control", "The paper's proportional controller; set points are zero for the template's own view."},
    {"supervisor", "When the robot must rest."},
    {"gate", "The last look before the wire."},
    {"robot", "The line to the P3-AT and the limits its own controller is given."},
    {"telemetry", "What is kept of a run."},
    {"runtime", "The process."},
};

// clang-format off
const ConfigKey kKeys[] = {
    address(HEEL_KEY(camera, source), "v4l2|libcamera|file|sim",
            "Where frames come from: v4l2:DEVICE, libcamera:ID, file:VIDEO-OR-FOLDER or sim:NAME."),
    path(HEEL_KEY(camera, info), "The camera's calibration: camera_info YAML as ROS and `heel calibrate` write it."),
    choice(HEEL_KEY(camera, format), "auto|YUYV|GREY|NV12|RGB3|BGR3|MJPG", No, "Pixel format asked of the driver; auto takes the cheapest it offers."),
    number(HEEL_KEY(camera, width_px), "px", {64, 4096}, No, "Frame width asked of the driver."),
    number(HEEL_KEY(camera, height_px), "px", {48, 4096}, No, "Frame height asked of the driver."),
    number(HEEL_KEY(camera, rate_hz), "Hz", {1, 240}, No, "Frame rate asked of the driver."),
    number(HEEL_KEY(camera, exposure_ms), "ms", {0, 1000}, No, "Exposure time; 0 leaves it automatic."),
    number(HEEL_KEY(camera, focus), "driver units", {-1, 1e6}, No, "Fixed focus; -1 leaves it alone."),
    number(HEEL_KEY(camera, gain), "driver units", {-1, 1e6}, No, "Fixed gain; -1 leaves it automatic."),
    number(HEEL_KEY(camera, file_speed), "times real time", {0, 100}, No, "Speed of a file source; 0 reads as fast as frames are asked for."),
    choice(HEEL_KEY(camera, at_end), "stop|loop", No, "After a file source's last frame: come to rest and exit, or begin again."),
    number(HEEL_KEY(camera, mount_x_m), "m", {-2, 2}, No, "Optical centre ahead of the robot's centre."),
    number(HEEL_KEY(camera, mount_y_m), "m", {-2, 2}, No, "Optical centre to the left of the robot's centre."),
    number(HEEL_KEY(camera, mount_z_m), "m", {0, 3}, No, "Optical centre above the floor."),
    number(HEEL_KEY(camera, mount_pitch_rad), "rad", {-0.8, 0.8}, No, "Tilt of the optical axis; positive looks up."),

    path(HEEL_KEY(target, shirt), "The template of the shirt's back, from `heel teach`."),
    number(HEEL_KEY(target, distance_m), "m", {0, 10}, No, "Distance at which the template was taken; 0 takes the template's own."),

    number(HEEL_KEY(vision, octaves), "", {1, 4}, No, "Octaves of scale searched for features."),
    number(HEEL_KEY(vision, max_features), "", {50, 5000}, No, "Strongest features kept of a frame."),
    number(HEEL_KEY(vision, match_ratio), "", {0.3, 1}, No, "Nearest over second nearest descriptor distance below which a match counts."),
    number(HEEL_KEY(vision, inlier_px), "px", {0.1, 20}, No, "Largest transfer error of a pair that supports a homography."),
    number(HEEL_KEY(vision, min_inliers), "", {4, 500}, No, "Fewer supporting pairs than this are no detection; nonsense gets four or five."),
    number(HEEL_KEY(vision, min_certainty), "", {0, 1}, No, "Smaller share of the template's features than this is no detection."),
    number(HEEL_KEY(vision, ransac_iterations), "", {10, 100000}, No, "Most samples drawn for one frame."),
    number(HEEL_KEY(vision, ransac_budget_ms), "ms", {0, 1000}, No, "Deadline of the sampling; 0 for none, which makes results repeatable."),
    number(HEEL_KEY(vision, distance_min_m), "m", {0.2, 20}, No, "Nearest distance at which the person is looked for."),
    number(HEEL_KEY(vision, distance_max_m), "m", {0.5, 30}, No, "Farthest distance at which the person is looked for."),
    flag(HEEL_KEY(vision, tracking), No, "Look first where the last frame says the person must be, and everywhere only when they are not there."),
    number(HEEL_KEY(vision, tracking_rate_rad_s), "rad/s", {0.1, 20}, No, "How fast the person may cross the view, the robot's own turning included; faster looks farther round the last place."),
    number(HEEL_KEY(vision, back_curvature_1_m), "1/m", {0, 5}, No, "How far the back's sides lie behind its middle: this times the square of the way to the side. An ellipse 0.4 m wide and 0.24 m deep has 1.5 in the middle; 0 takes the back for a plane, as the paper does and as fits a flat target."),
    number(HEEL_KEY(vision, back_curvature_sigma_1_m), "1/m", {0, 2}, No, "How much people's backs differ from that (one standard deviation); the stated deviations of the pose grow with it."),
    number(HEEL_KEY(vision, back_shape_sigma_m), "m", {0, 0.05}, No, "How far folds, breath and gait have moved the back since it was taught (one standard deviation of each of five smooth shapes); the stated deviations of the pose grow with it, too."),

    number(HEEL_KEY(estimate, acceleration_m_s2), "m/s²", {0.05, 20}, Yes, "How hard the person changes speed (one standard deviation); larger follows faster and smooths less."),
    number(HEEL_KEY(estimate, yaw_acceleration_rad_s2), "rad/s²", {0.05, 50}, Yes, "How hard the person changes direction (one standard deviation)."),
    number(HEEL_KEY(estimate, position_sigma_m), "m", {0.001, 1}, Yes, "Least standard deviation believed of a measured position."),
    number(HEEL_KEY(estimate, yaw_sigma_rad), "rad", {0.001, 1}, Yes, "Least standard deviation believed of a measured yaw."),
    number(HEEL_KEY(estimate, outlier_sigma), "standard deviations", {2, 100}, Yes, "A measurement farther than this from the prediction is set aside as a wild jump."),
    number(HEEL_KEY(estimate, outliers_to_reset), "frames", {1, 100}, Yes, "This many wild jumps in a row are believed after all and start the estimate anew."),

    number(HEEL_KEY(control, rate_hz), "Hz", {10, 200}, No, "Control ticks and velocity commands a second."),
    number(HEEL_KEY(control, gain_distance_1_s), "1/s", {0, 10}, Yes, "Speed for each metre of distance error (t_z)."),
    number(HEEL_KEY(control, gain_lateral_rad_s_m), "rad/s/m", {0, 10}, Yes, "Yaw rate for each metre of sideways error (t_x)."),
    number(HEEL_KEY(control, gain_yaw_1_s), "1/s", {0, 10}, Yes, "Yaw rate for each radian between the robot's heading and the person's."),
    number(HEEL_KEY(control, setpoint_t_z_m), "m", {-5, 10}, Yes, "Added to the template's distance; positive follows farther away."),
    number(HEEL_KEY(control, setpoint_t_x_m), "m", {-5, 5}, Yes, "Sideways offset; positive walks to the person's left."),
    number(HEEL_KEY(control, setpoint_yaw_rad), "rad", {-1.2, 1.2}, Yes, "Direction to follow from; positive circles to the person's right, still facing the person."),
    number(HEEL_KEY(control, deadband_distance_m), "m", {0, 1}, Yes, "Distance errors smaller than this do not turn the wheels."),
    flag(HEEL_KEY(control, reverse), Yes, "Whether the robot may back away when the person comes nearer."),
    number(HEEL_KEY(control, bearing_max_rad), "rad", {0.05, 1.5}, Yes, "The person is kept within this angle of the optical axis, whatever the gains ask; below half the field of view."),
    number(HEEL_KEY(control, bearing_gain_1_s), "1/s", {0.1, 20}, Yes, "How fast the person's bearing may approach that angle."),

    number(HEEL_KEY(supervisor, certainty_follow), "", {0, 1}, Yes, "Following starts at this certainty."),
    number(HEEL_KEY(supervisor, certainty_drop), "", {0, 1}, Yes, "While following, frames below this certainty do not count."),
    number(HEEL_KEY(supervisor, frames_to_follow), "frames", {1, 1000}, Yes, "Good frames in a row before the wheels turn."),
    number(HEEL_KEY(supervisor, target_timeout_s), "s", {0.05, 5}, Yes, "Without a good frame for this long the target counts as lost."),
    number(HEEL_KEY(supervisor, frame_timeout_s), "s", {0.05, 5}, Yes, "Without any frame for this long the camera counts as silent."),
    number(HEEL_KEY(supervisor, sip_timeout_s), "s", {0.15, 5}, Yes, "Without a packet from the robot for this long it counts as silent; it sends one each 0.1 s."),
    number(HEEL_KEY(supervisor, bumper_hold_s), "s", {0, 60}, Yes, "Rest this long after a bumper or a stall has cleared."),
    number(HEEL_KEY(supervisor, sonar_timeout_s), "s", {0.4, 5}, Yes, "Without a word from the front sonars for this long they count as silent, when robot.sonar is true; each is heard every 0.32 s."),

    number(HEEL_KEY(gate, v_max_m_s), "m/s", {0, 1.2}, Yes, "Largest speed commanded."),
    number(HEEL_KEY(gate, yaw_rate_max_rad_s), "rad/s", {0, 4}, Yes, "Largest yaw rate commanded."),
    number(HEEL_KEY(gate, acceleration_m_s2), "m/s²", {0.05, 5}, Yes, "Largest gain of speed."),
    number(HEEL_KEY(gate, deceleration_m_s2), "m/s²", {0.05, 5}, Yes, "Largest loss of speed, coming to rest included."),
    number(HEEL_KEY(gate, separation_m), "m", {0, 5}, Yes, "The robot does not drive nearer to the person than this, camera to back."),
    number(HEEL_KEY(gate, clearance_m), "m", {0, 2}, Yes, "The robot does not drive nearer than this to what its sonars hear in its way, bumper to echo."),
    number(HEEL_KEY(gate, yaw_acceleration_rad_s2), "rad/s²", {0.05, 50}, Yes, "Largest change of yaw rate."),
    number(HEEL_KEY(gate, command_lifetime_s), "s", {0.02, 1}, Yes, "A velocity command not renewed for this long counts as zero."),

    address(HEEL_KEY(robot, address), "serial|pty|tcp", "The robot's controller: serial:DEVICE@BAUD, pty:PATH@BAUD or tcp:HOST:PORT. BAUD, 38400 without it, is tried first, then the robot's other rates; a slower robot that can change is brought to BAUD."),
    flag(HEEL_KEY(robot, sonar), No, "Whether the sonars are on; they click. Off, for a robot without any, nothing but the bumpers knows of obstacles."),
    flag(HEEL_KEY(robot, request_config), No, "Whether the robot is asked for its own settings after connecting."),
    number(HEEL_KEY(robot, config_wait_s), "s", {0, 30}, No, "How long to wait for those settings before going on without."),
    number(HEEL_KEY(robot, sync_retry_s), "s", {0.1, 30}, No, "Pause between attempts to synchronise."),
    number(HEEL_KEY(robot, reconnect_s), "s", {0.1, 60}, No, "Pause before a lost line is opened again."),
    number(HEEL_KEY(robot, dist_conv_factor), "mm a unit", {0.01, 10}, No, "Millimetres in one unit of the robot's odometry: 1.0 for p3at-sh, 0.465 for p3at."),
    number(HEEL_KEY(robot, v_limit_mm_s), "mm/s", {0, 1200}, No, "Speed limit given to the robot's controller (SETV)."),
    number(HEEL_KEY(robot, yaw_rate_limit_deg_s), "deg/s", {0, 300}, No, "Turning limit given to the robot's controller (SETRV)."),
    number(HEEL_KEY(robot, acceleration_mm_s2), "mm/s²", {1, 5000}, No, "Acceleration given to the robot's controller (SETA)."),
    number(HEEL_KEY(robot, deceleration_mm_s2), "mm/s²", {1, 5000}, No, "Deceleration given to the robot's controller (SETA, negative)."),
    number(HEEL_KEY(robot, yaw_acceleration_deg_s2), "deg/s²", {1, 5000}, No, "Turning acceleration given to the robot's controller (SETRA)."),

    path(HEEL_KEY(telemetry, directory), "Folder for recordings; empty records nothing."),

    choice(HEEL_KEY(runtime, log_level), "trace|debug|info|warn|error", Yes, "Least important message written to the log."),
    choice(HEEL_KEY(runtime, ready_after), "all|robot|start", No, "What has to be there before systemd is told READY: robot and first frame, the robot alone, or nothing."),
    flag(HEEL_KEY(runtime, realtime), No, "Whether to ask for real-time priorities and locked memory; refused, heeld says so and goes on."),
    number(HEEL_KEY(runtime, priority_control), "", {1, 98}, No, "SCHED_FIFO priority of the control thread."),
    number(HEEL_KEY(runtime, priority_capture), "", {1, 98}, No, "SCHED_FIFO priority of the capture thread."),
    number(HEEL_KEY(runtime, priority_vision), "", {1, 98}, No, "SCHED_FIFO priority of the vision thread."),
};
// clang-format on

#undef HEEL_KEY

constexpr ConfigRelation kRelations[] = {
    {"vision.distance_max_m",
     [](const Config& c) { return c.vision.distance_min_m < c.vision.distance_max_m; },
     "must be larger than vision.distance_min_m"},
    {"supervisor.certainty_drop",
     [](const Config& c) { return c.supervisor.certainty_drop <= c.supervisor.certainty_follow; },
     "must not be larger than supervisor.certainty_follow"},
    {"gate.command_lifetime_s",
     [](const Config& c) { return c.gate.command_lifetime_s * c.control.rate_hz >= 2.0; },
     "must be at least two periods of control.rate_hz"},
    {"gate.v_max_m_s", [](const Config& c) { return c.gate.v_max_m_s * 1000.0 <= c.robot.v_limit_mm_s; },
     "must not be larger than robot.v_limit_mm_s"},
};

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  std::string result(text.data(), end);
  return result;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

/// "a|b|c" → "a, b or c".
std::string listed(std::string_view choices) {
  std::string result;
  while (!choices.empty()) {
    const auto bar = choices.find('|');
    const bool last = bar == std::string_view::npos;
    if (!result.empty()) result += last ? " or " : ", ";
    result += choices.substr(0, bar);
    choices = last ? std::string_view{} : choices.substr(bar + 1);
  }
  return result;
}

}  // namespace

std::span<const ConfigSection> config_sections() {
  return kSections;
}

std::span<const ConfigKey> config_keys() {
  return kKeys;
}

std::span<const ConfigRelation> config_relations() {
  return kRelations;
}

std::string toml_value(const ConfigKey& key, const Config& config) {
  auto& fields = const_cast<Config&>(config);  // accessors are shared with the parser; this only reads
  struct Writer {
    Config& c;
    std::string operator()(bool* (*f)(Config&)) const { return *f(c) ? "true" : "false"; }
    std::string operator()(int* (*f)(Config&)) const { return std::to_string(*f(c)); }
    std::string operator()(double* (*f)(Config&)) const {
      const std::string text = shortest(*f(c));
      return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
    }
    std::string operator()(std::string* (*f)(Config&)) const { return heel::quoted(*f(c)); }
  };
  return std::visit(Writer{fields}, key.field);
}

std::string_view type_name(const ConfigKey& key) {
  switch (key.field.index()) {
    case 0:
      return "bool";
    case 1:
      return "int";
    case 2:
      return "real";
    default:
      break;
  }
  switch (key.text) {
    case ConfigText::Choice:
      return "choice";
    case ConfigText::Path:
      return "path";
    case ConfigText::Address:
      return "address";
  }
  return "?";
}

std::string expected_value(const ConfigKey& key) {
  const std::string_view type = type_name(key);
  if (type == "bool") return "true or false";
  if (type == "path") return "a path in quotes";
  if (type == "address") return listed(key.choices) + ", a colon and the place, in quotes";
  if (type == "choice") return listed(key.choices);
  std::string result = type == "int" ? "a whole number " : "a number ";
  result += shortest(key.min) + "…" + shortest(key.max);
  if (!key.unit.empty()) result += " " + std::string(key.unit);
  return result;
}

}  // namespace heel
