// Every configuration key, once: name, type (by the member it fills), unit, range, reload or the safer
// direction, effect.
#include "config/config_table.h"

namespace heel {
namespace {

// A key has the name of the member it fills, so that the two always agree.
#define HEEL_KEY(section, name) #section, #name, [](Config & c) { return &c.section.name; }

using enum Reload;
using enum Tighter;

struct Range {
  double min, max;
};

using Name = std::string_view;

constexpr ConfigKey number(Name section, Name name, double* (*field)(Config&), Name unit, Range range,
                           Reload reload, Name effect) {
  return {section, name,   field,         unit,  range.min, range.max, ConfigText::Choice,
          "",      reload, Tighter::None, effect};
}
constexpr ConfigKey number(Name section, Name name, int* (*field)(Config&), Name unit, Range range,
                           Reload reload, Name effect) {
  return {section, name,   field,         unit,  range.min, range.max, ConfigText::Choice,
          "",      reload, Tighter::None, effect};
}
constexpr ConfigKey flag(Name section, Name name, bool* (*field)(Config&), Reload reload, Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Choice, "", reload, Tighter::None, effect};
}
/// A limit of the robot's motion, or of what it may know too little of to move. It reloads.
constexpr ConfigKey limit(Name section, Name name, double* (*field)(Config&), Name unit, Range range,
                          Tighter tighter, Name effect) {
  return {section, name, field, unit, range.min, range.max, ConfigText::Choice, "", Yes, tighter, effect};
}
constexpr ConfigKey limit(Name section, Name name, int* (*field)(Config&), Name unit, Range range,
                          Tighter tighter, Name effect) {
  return {section, name, field, unit, range.min, range.max, ConfigText::Choice, "", Yes, tighter, effect};
}
constexpr ConfigKey limit(Name section, Name name, bool* (*field)(Config&), Tighter tighter, Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Choice, "", Yes, tighter, effect};
}
constexpr ConfigKey choice(Name section, Name name, std::string* (*field)(Config&), Name choices,
                           Reload reload, Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Choice, choices, reload, Tighter::None, effect};
}
constexpr ConfigKey path(Name section, Name name, std::string* (*field)(Config&), Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Path, "", No, Tighter::None, effect};
}
constexpr ConfigKey paths(Name section, Name name, std::vector<std::string>* (*field)(Config&), double most,
                          Name effect) {
  return {section, name, field, "", 0, most, ConfigText::Path, "", No, Tighter::None, effect};
}
constexpr ConfigKey names(Name section, Name name, std::vector<std::string>* (*field)(Config&), double most,
                          Name effect) {
  return {section, name, field, "", 0, most, ConfigText::Name, "", No, Tighter::None, effect};
}
constexpr ConfigKey listen_address(Name section, Name name, std::string* (*field)(Config&), Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Listen, "", No, Tighter::None, effect};
}
constexpr ConfigKey address(Name section, Name name, std::string* (*field)(Config&), Name schemes,
                            Name effect) {
  return {section, name, field, "", 0, 0, ConfigText::Address, schemes, No, Tighter::None, effect};
}
constexpr ConfigKey line(Name section, Name name, std::string* (*field)(Config&), ConfigText text,
                         Name effect) {
  return {section, name, field, "", 0, 0, text, "", No, Tighter::None, effect};
}

constexpr ConfigSection kSections[] = {
    {"camera", "The camera and its position on the robot."},
    {"target", "The person to follow."},
    {"vision", "The estimation of the shirt's pose in each frame."},
    {"estimate", "The estimate of the person's pose in the odometry frame."},
    {"control", "The control law; with set points of zero the robot takes the view of the template."},
    {"supervisor", "The conditions under which the robot must be at rest."},
    {"gate", "The limits of every command that is sent to the robot."},
    {"robot", "The line to the robot, and the limits set in the robot's own controller."},
    {"telemetry", "The recording of a run."},
    {"operator", "The commands of operators."},
    {"view",
     "The page for browsers, and what monitoring reads: docs/page.md. Off until there is an address."},
    {"mqtt",
     "The status for an MQTT broker, never a command from it: docs/how-to/mqtt.md. Off until there is an "
     "address."},
    {"runtime", "The process: log, start-up and real-time priorities."},
};

// clang-format off
const ConfigKey kKeys[] = {
    address(HEEL_KEY(camera, source), "v4l2|libcamera|file|sim",
            "Where frames come from: v4l2:DEVICE, libcamera:ID, file:VIDEO-OR-FOLDER or sim:NAME."),
    path(HEEL_KEY(camera, info), "The camera's calibration file: camera_info YAML, as ROS and `heel calibrate` write it."),
    choice(HEEL_KEY(camera, format), "auto|YUYV|GREY|NV12|RGB3|BGR3|MJPG", No, "Pixel format requested from the driver; auto tries the formats in the order of their conversion cost and takes the first that reaches the frame rate."),
    number(HEEL_KEY(camera, width_px), "px", {64, 4096}, No, "Frame width requested from the driver."),
    number(HEEL_KEY(camera, height_px), "px", {48, 4096}, No, "Frame height requested from the driver."),
    number(HEEL_KEY(camera, rate_hz), "Hz", {1, 240}, No, "Frame rate requested from the driver."),
    number(HEEL_KEY(camera, exposure_ms), "ms", {0, 1000}, No, "Exposure time; 0 sets automatic exposure."),
    number(HEEL_KEY(camera, focus), "driver units", {-1, 1e6}, No, "Fixed focus; -1 leaves the focus as it is."),
    number(HEEL_KEY(camera, gain), "driver units", {-1, 1e6}, No, "Fixed gain; -1 sets automatic gain."),
    number(HEEL_KEY(camera, file_speed), "× real time", {0, 100}, No, "Speed of a file source; 0 delivers each frame as soon as it is requested, which heeld refuses because it runs in real time."),
    choice(HEEL_KEY(camera, at_end), "stop|loop", No, "After the last frame of a file source: stop brings the robot to rest and exits, loop plays the file again."),
    number(HEEL_KEY(camera, rotate), "deg", {0, 270}, No, "Turns each picture clockwise, so that it is upright: 0, 90, 180 or 270. The calibration stays that of the pictures as the camera sends them."),
    flag(HEEL_KEY(camera, mirror), No, "Mirrors each picture left to right, before it is turned: for a camera that sends a mirror image."),
    number(HEEL_KEY(camera, mount_x_m), "m", {-2, 2}, No, "Position of the optical centre in front of the robot's centre."),
    number(HEEL_KEY(camera, mount_y_m), "m", {-2, 2}, No, "Position of the optical centre to the left of the robot's centre."),
    number(HEEL_KEY(camera, mount_z_m), "m", {0, 3}, No, "Height of the optical centre above the floor."),
    number(HEEL_KEY(camera, mount_pitch_rad), "rad", {-0.8, 0.8}, No, "Tilt of the optical axis; positive looks up."),
    number(HEEL_KEY(camera, mount_yaw_rad), "rad", {-0.8, 0.8}, No, "Direction of the optical axis against the robot's heading; positive looks to the left."),
    number(HEEL_KEY(camera, mount_roll_rad), "rad", {-0.8, 0.8}, No, "Roll of the upright picture about the optical axis; positive: the camera's right side is lower."),

    path(HEEL_KEY(target, shirt), "The template of the back of the shirt, made by `heel teach`."),
    paths(HEEL_KEY(target, more_shirts), 7, "More templates of the same person: from the side or the front (`heel teach --yaw`), from another distance, in other light. In a frame in which the current template is not found, one other is searched."),
    number(HEEL_KEY(target, distance_m), "m", {0, 10}, No, "Distance at which target.shirt was taken; 0 uses the distance stored in the template."),

    number(HEEL_KEY(vision, octaves), "", {1, 4}, No, "Octaves of scale in which features are searched."),
    number(HEEL_KEY(vision, max_features), "", {50, 5000}, No, "Largest number of features kept in a frame 640 pixels wide, in proportion in a wider one; the strongest are kept."),
    number(HEEL_KEY(vision, match_ratio), "", {0.3, 1}, No, "Largest ratio of the nearest to the second nearest descriptor distance of an accepted match."),
    number(HEEL_KEY(vision, inlier_px), "px", {0.1, 20}, No, "Largest transfer error of an inlier of the homography."),
    number(HEEL_KEY(vision, min_inliers), "", {4, 500}, No, "Smallest number of inliers of a detection; wrong homographies reach four or five."),
    number(HEEL_KEY(vision, min_certainty), "", {0, 1}, No, "Smallest certainty of a detection: inliers / features of the template."),
    number(HEEL_KEY(vision, ransac_iterations), "", {10, 100000}, No, "Largest number of RANSAC samples in one frame."),
    number(HEEL_KEY(vision, distance_min_m), "m", {0.2, 20}, No, "Nearest distance at which the person is searched for."),
    number(HEEL_KEY(vision, distance_max_m), "m", {0.5, 30}, No, "Farthest distance at which the person is searched for."),
    flag(HEEL_KEY(vision, tracking), No, "Whether to search first where the last frame predicts the person, and in the whole frame only if the person is not there."),
    number(HEEL_KEY(vision, tracking_rate_rad_s), "rad/s", {0.1, 20}, No, "Largest rate at which the person may cross the view, the robot's own rotation included; a larger value widens the region that is searched first."),
    number(HEEL_KEY(vision, back_curvature_1_m), "1/m", {0, 5}, No, "How curved the back is: 1.5 is the average shape measured on real backs, other values scale its depths in proportion. 0 models a plane, as the paper does; use it for a flat target."),
    number(HEEL_KEY(vision, back_curvature_sigma_1_m), "1/m", {0, 2}, No, "Standard deviation of that curvature between people; the standard deviations of the pose include it."),
    number(HEEL_KEY(vision, back_shape_sigma_m), "m", {0, 0.05}, No, "How far cloth and body lie from where they were when the template was taken (folds, breathing, gait), one standard deviation of each smooth departure; the standard deviations of the pose include it."),

    number(HEEL_KEY(estimate, acceleration_m_s2), "m/s²", {0.05, 20}, Yes, "Standard deviation of the person's acceleration; a larger value reacts faster and smooths less."),
    number(HEEL_KEY(estimate, yaw_acceleration_rad_s2), "rad/s²", {0.05, 50}, Yes, "Standard deviation of the person's yaw acceleration."),
    number(HEEL_KEY(estimate, position_sigma_m), "m", {0.001, 1}, Yes, "Smallest standard deviation assumed for a measured position."),
    number(HEEL_KEY(estimate, yaw_sigma_rad), "rad", {0.001, 1}, Yes, "Smallest standard deviation assumed for a measured yaw."),
    number(HEEL_KEY(estimate, outlier_sigma), "standard deviations", {2, 100}, Yes, "A measurement farther than this from the prediction is rejected as an outlier."),
    number(HEEL_KEY(estimate, outliers_to_reset), "frames", {1, 100}, Yes, "Outliers in a row after which the estimate restarts from the last one."),

    number(HEEL_KEY(control, rate_hz), "Hz", {10, 200}, No, "Control ticks, and velocity commands, per second."),
    choice(HEEL_KEY(control, law), "view|position|trail", No, "The control law: trail drives along the person's own path at the set distance, measured along it; view drives to the pose from which the template was taken, behind the person in their direction of travel; position uses the person's position only and is the base line for comparisons."),
    number(HEEL_KEY(control, gain_distance_1_s), "1/s", {0, 10}, Yes, "Speed per metre of distance error (t_z)."),
    number(HEEL_KEY(control, gain_lateral_rad_s_m), "rad/s/m", {0, 10}, Yes, "Yaw rate per metre of sideways error (t_x), with the laws view and position."),
    number(HEEL_KEY(control, gain_yaw_1_s), "1/s", {0, 10}, Yes, "Yaw rate per radian between the robot's heading and the person's direction of travel, with the law view; the other laws do not use it."),
    number(HEEL_KEY(control, setpoint_t_z_m), "m", {-5, 10}, Yes, "Added to the template's distance; positive follows from farther away."),
    number(HEEL_KEY(control, setpoint_t_x_m), "m", {-5, 5}, Yes, "Sideways offset; positive drives to the left of the person."),
    number(HEEL_KEY(control, setpoint_yaw_rad), "rad", {-1.2, 1.2}, Yes, "Direction from which to follow, with the laws view and position; positive moves the robot around the person to their right side, still facing the person."),
    number(HEEL_KEY(control, deadband_distance_m), "m", {0, 1}, Yes, "Distance errors smaller than this cause no motion."),
    limit(HEEL_KEY(control, reverse), Smaller, "Whether the robot may drive backwards when the person comes nearer."),
    number(HEEL_KEY(control, bearing_max_rad), "rad", {0.05, 1.5}, Yes, "Largest angle between the person and the optical axis, whatever the other gains command; smaller than half the field of view."),
    number(HEEL_KEY(control, acceleration_m_s2), "m/s²", {0.05, 5}, Yes, "Largest acceleration that the law commands."),
    number(HEEL_KEY(control, deceleration_m_s2), "m/s²", {0.05, 5}, Yes, "Largest deceleration that the law commands. The gate may brake harder, without the limit of jerk."),
    number(HEEL_KEY(control, jerk_m_s3), "m/s³", {0.1, 1000}, Yes, "Largest change of acceleration in a second that the law commands."),
    number(HEEL_KEY(control, yaw_acceleration_rad_s2), "rad/s²", {0.05, 20}, Yes, "Largest yaw acceleration that the law commands."),
    number(HEEL_KEY(control, yaw_jerk_rad_s3), "rad/s³", {0.5, 10000}, Yes, "Largest change of yaw acceleration in a second that the law commands."),
    number(HEEL_KEY(control, trail_reach_m), "m", {0.1, 5}, Yes, "With the law trail: how far the robot drives until most of an offset from the trail is gone. Smaller is stiffer."),
    number(HEEL_KEY(control, trail_smooth_m), "m", {0.2, 3}, Yes, "With the law trail: the trail is smoothed over this length ahead of a place and behind it; more than the length of a stride."),
    number(HEEL_KEY(control, trail_delay_s), "s", {0, 1}, Yes, "With the law trail: time from a command to the motion, which the law predicts the robot over."),
    number(HEEL_KEY(control, trail_bearing_rad), "rad", {0.05, 1.5}, Yes, "With the law trail, in place of control.bearing_max_rad: largest angle between the person and the optical axis. The law allows for the person's own motion, so that this angle may be nearer to half the field of view."),
    number(HEEL_KEY(control, detour_m), "m", {0, 1}, Yes, "With the law trail: how far beside the trail the robot passes an obstacle at most; 0: it waits."),
    number(HEEL_KEY(control, search_m_s), "m/s", {0, 2}, Yes, "With the law trail: largest speed along the rest of the trail when the person is lost; 0: it waits."),
    number(HEEL_KEY(control, search_look_rad), "rad", {0, 3}, Yes, "With the law trail: how far it looks to either side at the end of the trail."),
    number(HEEL_KEY(control, search_turn_rad_s), "rad/s", {0.1, 2}, Yes, "With the law trail: yaw rate while it looks."),
    number(HEEL_KEY(control, bearing_gain_1_s), "1/s", {0.1, 20}, Yes, "How fast the person's bearing may approach control.bearing_max_rad: rad/s per radian that is left."),

    choice(HEEL_KEY(supervisor, start), "operator|at_once", No, "What lets the robot move: operator is the command `heel start`, needed after each start of heeld and after each fault; at_once, for test benches, needs no command, also not after a fault."),
    limit(HEEL_KEY(supervisor, certainty_follow), "", {0, 1}, Larger, "Certainty at which following starts."),
    limit(HEEL_KEY(supervisor, certainty_drop), "", {0, 1}, Larger, "While following, a frame below this certainty is not a good frame."),
    limit(HEEL_KEY(supervisor, frames_to_follow), "frames", {1, 1000}, Larger, "Good frames in a row that are needed before the robot moves."),
    limit(HEEL_KEY(supervisor, target_timeout_s), "s", {0.05, 5}, Smaller, "Time without a good frame after which the target counts as lost."),
    limit(HEEL_KEY(supervisor, frame_timeout_s), "s", {0.05, 5}, Smaller, "Time without any frame after which the camera counts as silent."),
    limit(HEEL_KEY(supervisor, sip_timeout_s), "s", {0.15, 5}, Smaller, "Time without a packet from the robot after which the robot counts as silent; it sends one every 0.1 s."),
    limit(HEEL_KEY(supervisor, bumper_hold_s), "s", {0, 60}, Larger, "Time at rest after a bumper or a stall has cleared."),
    limit(HEEL_KEY(supervisor, sonar_timeout_s), "s", {0.4, 5}, Smaller, "Time without a reading of the front sonars after which they count as silent, if robot.sonar is true; each is read every 0.32 s."),
    limit(HEEL_KEY(supervisor, search_s), "s", {0, 60}, Smaller, "Longest time for which a control law that can drive on without the target may do so."),
    limit(HEEL_KEY(supervisor, battery_low_v), "V", {0, 60}, Larger, "Voltage below which, for 2 s, the robot's battery counts as low and the robot stops; 0: never."),
    limit(HEEL_KEY(supervisor, battery_ok_v), "V", {0, 60}, Larger, "Voltage from which a low battery no longer counts as low."),
    limit(HEEL_KEY(supervisor, lateness_max_s), "s", {0, 5}, Neither, "A control tick that runs later than this stops the robot; 0: none does."),
    limit(HEEL_KEY(supervisor, operator_timeout_s), "s", {0, 600}, Neither, "Time without a sign of the operator after which the robot stops; 0: none is needed."),

    limit(HEEL_KEY(gate, v_max_m_s), "m/s", {0, 1.2}, Smaller, "Largest speed commanded."),
    limit(HEEL_KEY(gate, yaw_rate_max_rad_s), "rad/s", {0, 4}, Smaller, "Largest yaw rate commanded."),
    limit(HEEL_KEY(gate, acceleration_m_s2), "m/s²", {0.05, 5}, Smaller, "Largest increase of speed."),
    limit(HEEL_KEY(gate, deceleration_m_s2), "m/s²", {0.05, 5}, Neither, "Largest decrease of speed, also when braking to rest."),
    limit(HEEL_KEY(gate, separation_m), "m", {0, 5}, Larger, "The robot does not drive nearer to the person than this, measured from the camera to the back."),
    limit(HEEL_KEY(gate, clearance_m), "m", {0, 2}, Larger, "The robot does not drive nearer than this to an obstacle that its sonars detect in front of its body, measured from the bumper to the echo."),
    limit(HEEL_KEY(gate, yaw_acceleration_rad_s2), "rad/s²", {0.05, 50}, Neither, "Largest change of yaw rate."),
    limit(HEEL_KEY(gate, command_lifetime_s), "s", {0.02, 1}, Smaller, "Time after which a velocity command that was not renewed counts as zero."),

    address(HEEL_KEY(robot, address), "serial|pty|tcp", "The robot's controller: serial:DEVICE@BAUD, pty:PATH@BAUD or tcp:HOST:PORT. BAUD (38400 if missing) is tried first, then the robot's other rates; a controller that answers at a slower rate and can change it is switched to BAUD."),
    choice(HEEL_KEY(robot, model), "auto|p3at-sh|p3at|p3dx-sh|p3dx|p2at8|p2at|amigo-sh|amigo|peoplebot-sh|powerbot-sh", No, "The robot's subclass, which decides its units, outline and sonar places. auto takes what the robot says when it connects; with a name, a robot that says another one is not driven."),
    flag(HEEL_KEY(robot, sonar), No, "Whether the sonars are on; they click audibly. When they are off, only the bumpers detect obstacles."),
    flag(HEEL_KEY(robot, request_config), No, "Whether to request the controller's settings (CONFIGpac) after connecting."),
    number(HEEL_KEY(robot, config_wait_s), "s", {0, 30}, No, "How long to wait for these settings before going on without them."),
    number(HEEL_KEY(robot, sync_retry_s), "s", {0.1, 30}, No, "Pause between attempts to synchronise."),
    number(HEEL_KEY(robot, reconnect_s), "s", {0.1, 60}, No, "Pause before a lost line is opened again."),
    number(HEEL_KEY(robot, v_limit_mm_s), "mm/s", {0, 1200}, No, "Speed limit set in the robot's controller (SETV)."),
    number(HEEL_KEY(robot, yaw_rate_limit_deg_s), "deg/s", {0, 300}, No, "Yaw rate limit set in the robot's controller (SETRV)."),
    number(HEEL_KEY(robot, acceleration_mm_s2), "mm/s²", {1, 5000}, No, "Acceleration set in the robot's controller (SETA)."),
    number(HEEL_KEY(robot, deceleration_mm_s2), "mm/s²", {1, 5000}, No, "Deceleration set in the robot's controller (SETA, negative)."),
    number(HEEL_KEY(robot, yaw_acceleration_deg_s2), "deg/s²", {1, 5000}, No, "Yaw acceleration and deceleration set in the robot's controller (SETRA)."),

    path(HEEL_KEY(telemetry, directory), "Folder for recordings; with an empty name nothing is recorded."),
    choice(HEEL_KEY(telemetry, pictures), "none|on_fault|jpeg|lossless", No, "Which of the frames that vision has processed are recorded, in grey: none; on_fault, the last 30 s before a fault or a `heel mark`, as JPEG; jpeg, all as JPEG; lossless, all as PNG, so that `heel replay` repeats vision to the bit."),
    number(HEEL_KEY(telemetry, keep_mb), "MB", {10, 1e6}, No, "Recordings in the folder beyond so many megabytes are removed, the oldest first. A run that needs more by itself is recorded up to there."),
    number(HEEL_KEY(telemetry, keep_days), "d", {0.01, 3650}, No, "Recordings older than so many days are removed."),
    path(HEEL_KEY(telemetry, black_box), "File in memory (a tmpfs) with the last 30 s of ticks, poses, events and bytes on the wire, which outlives a crash of heeld; the next start makes a recording of it. With an empty name there is none."),

    // "operator" is a word of C++: its member has another name.
    path("operator", "socket", [](Config& c) { return &c.operators.socket; }, "The local socket that `heel status`, `heel start` and the like connect to; the user and the group that heeld runs under may. With an empty name there is none, and with supervisor.start = \"operator\" the robot then never moves."),

    listen_address(HEEL_KEY(view, address), "Where the page is served: 127.0.0.1:8080 for this computer alone (or a reverse proxy on it), 0.0.0.0:8080 for its networks; port 0 takes a free one, which the log names. With an empty text nothing is served."),
    path(HEEL_KEY(view, token_file), "File with the token, at least 16 characters, that a browser must know to change anything; with an empty name the systemd credential view-token, when there is one. Without a token nothing can be changed over the network; an emergency stop needs none."),
    names(HEEL_KEY(view, hosts), 16, "Names by which browsers may reach the page, besides IP addresses and localhost; a page under another name is refused. A viewer for Foxglove that is loaded from another site needs that site's name here."),
    number(HEEL_KEY(view, picture_hz), "Hz", {0.1, 30}, No, "Largest rate of the pictures that the page shows. None is made while nobody looks."),
    number(HEEL_KEY(view, picture_quality), "", {10, 95}, No, "Quality of these JPEG pictures."),

    line(HEEL_KEY(mqtt, address), ConfigText::Broker, "The MQTT broker to which the status goes: tcp://HOST:1883, or ssl://HOST:8883 for TLS. With an empty text nothing is published."),
    line(HEEL_KEY(mqtt, topic), ConfigText::Topic, "The status is published at this topic followed by /status, and whether heeld is there at this topic followed by /online. {host} stands for this computer's name. Each robot needs a topic of its own."),
    line(HEEL_KEY(mqtt, user), ConfigText::Text, "The name that the broker knows this robot by; with an empty text it is given none."),
    path(HEEL_KEY(mqtt, password_file), "File with the password of mqtt.user; with an empty name the systemd credential mqtt-password, when there is one."),
    path(HEEL_KEY(mqtt, ca_file), "File with the certificates (PEM) of the authorities that may vouch for a broker at ssl://; with an empty name those that the system trusts."),
    number(HEEL_KEY(mqtt, period_s), "s", {0.1, 3600}, No, "The status is published this often, and at once when the state or its reason changes."),

    choice(HEEL_KEY(runtime, log_level), "trace|debug|info|warn|error", Yes, "Lowest level of the messages that are logged."),
    choice(HEEL_KEY(runtime, ready_after), "all|robot|start", No, "When systemd receives READY: all is after the robot has answered and the first frame has come, robot is after the robot has answered, start is at once."),
    flag(HEEL_KEY(runtime, realtime), No, "Whether to request real-time priorities and locked memory; if they are refused, heeld logs a warning and continues."),
    number(HEEL_KEY(runtime, priority_control), "", {1, 98}, No, "SCHED_FIFO priority of the control thread."),
    number(HEEL_KEY(runtime, priority_capture), "", {1, 98}, No, "SCHED_FIFO priority of the capture thread."),
    number(HEEL_KEY(runtime, priority_vision), "", {1, 98}, No, "SCHED_FIFO priority of the vision thread."),
    number(HEEL_KEY(runtime, core_control), "", {-1, 1023}, No, "Processor core of the control thread, for machines with cores set aside (isolcpus); -1: any."),
    number(HEEL_KEY(runtime, core_capture), "", {-1, 1023}, No, "Processor core of the capture thread; -1: any."),
    number(HEEL_KEY(runtime, core_vision), "", {-1, 1023}, No, "Processor core of the vision thread; -1: any."),
};
// clang-format on

#undef HEEL_KEY

constexpr ConfigRelation kRelations[] = {
    {"camera.rotate", [](const Config& c) { return c.camera.rotate % 90 == 0; }, "must be 0, 90, 180 or 270",
     true},
    {"vision.distance_max_m",
     [](const Config& c) { return c.vision.distance_min_m < c.vision.distance_max_m; },
     "must be larger than vision.distance_min_m"},
    {"supervisor.certainty_drop",
     [](const Config& c) { return c.supervisor.certainty_drop <= c.supervisor.certainty_follow; },
     "must not be larger than supervisor.certainty_follow"},
    {"supervisor.battery_ok_v",
     [](const Config& c) { return c.supervisor.battery_ok_v >= c.supervisor.battery_low_v; },
     "must not be smaller than supervisor.battery_low_v"},
    {"gate.command_lifetime_s",
     [](const Config& c) { return c.gate.command_lifetime_s * c.control.rate_hz >= 2.0; },
     "must be at least two periods of control.rate_hz"},
    {"gate.v_max_m_s", [](const Config& c) { return c.gate.v_max_m_s * 1000.0 <= c.robot.v_limit_mm_s; },
     "must not be larger than robot.v_limit_mm_s"},
    {"mqtt.password_file",
     [](const Config& c) { return c.mqtt.password_file.empty() || !c.mqtt.user.empty(); },
     "is the password of mqtt.user, which must not be empty then"},
    {"mqtt.ca_file",
     [](const Config& c) { return c.mqtt.ca_file.empty() || c.mqtt.address.starts_with("ssl://"); },
     "is for an mqtt.address that begins with ssl://"},
};

constexpr RemovedConfigKey kRemovedKeys[] = {
    {"robot.dist_conv_factor", "the robot's subclass decides it (robot.model)"},
    {"vision.ransac_budget_ms", "vision.ransac_iterations alone limits RANSAC"},
};

}  // namespace

std::span<const ConfigSection> config_sections() {
  return kSections;
}

std::span<const ConfigKey> config_keys() {
  return kKeys;
}

std::optional<std::size_t> index_of_key(std::string_view full_name) {
  for (std::size_t i = 0; i < std::size(kKeys); ++i) {
    if (kKeys[i].full_name() == full_name) return i;
  }
  return std::nullopt;
}

std::span<const ConfigRelation> config_relations() {
  return kRelations;
}

std::span<const RemovedConfigKey> removed_config_keys() {
  return kRemovedKeys;
}

}  // namespace heel
