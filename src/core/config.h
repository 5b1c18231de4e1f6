// The daemon's configuration as typed structs. Each key's unit, range and effect stands in one table,
// src/config/config_table.cpp, from which the parser, config/heel.toml and docs/configuration.md are made.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "heel/vision_config.h"

namespace heel {

struct CameraConfig {
  std::string source = "v4l2:/dev/heel-camera";  ///< camera address, KIND:REST
  std::string info = "camera.yaml";              ///< camera_info YAML
  std::string format = "auto";                   ///< auto, YUYV, GREY, NV12, RGB3, BGR3, MJPG
  int width_px = 640;
  int height_px = 480;
  double rate_hz = 30.0;
  double exposure_ms = 0.0;     ///< 0: automatic
  double focus = -1.0;          ///< driver units; −1: unchanged
  double gain = -1.0;           ///< driver units; −1: automatic
  double file_speed = 1.0;      ///< file source: factor on its rate; 0: each frame as soon as it is requested
  std::string at_end = "stop";  ///< after a file source's last frame: stop (come to rest and exit) or loop
  // What makes the camera's pictures upright: first mirrored, then turned.
  int rotate = 0;  ///< degrees clockwise: 0, 90, 180, 270
  bool mirror = false;
  // Mount: the camera's optical centre in the robot frame.
  double mount_x_m = 0.15;
  double mount_y_m = 0.0;
  double mount_z_m = 1.0;
  double mount_pitch_rad = 0.0;  ///< + looks up
  double mount_yaw_rad = 0.0;    ///< + looks to the left
  double mount_roll_rad = 0.0;   ///< + the right side is lower

  /// Recorded pictures: they do not answer the robot's motion.
  bool from_file() const { return source.starts_with("file:"); }
};

struct TargetConfig {
  std::string shirt = "shirt.heel";      ///< the template file
  std::vector<std::string> more_shirts;  ///< further templates of the same person
  double distance_m = 0.0;               ///< in place of the template's distance; 0: the template's
};

struct EstimateConfig {
  double acceleration_m_s2 = 1.0;        ///< standard deviation of the person's acceleration
  double yaw_acceleration_rad_s2 = 0.8;  ///< standard deviation of the person's yaw acceleration
  double position_sigma_m = 0.03;        ///< smallest standard deviation of a measured position
  double yaw_sigma_rad = 0.03;           ///< smallest standard deviation of a measured yaw
  double outlier_sigma = 5.0;  ///< a measurement farther than this from the prediction is an outlier
  int outliers_to_reset = 5;   ///< outliers in a row after which the estimate starts again
};

struct ControlConfig {
  double rate_hz = 50.0;
  std::string law = "view";           ///< name of the control law
  double gain_distance_1_s = 1.0;     ///< v = gain · t_z error (m → m/s)
  double gain_lateral_rad_s_m = 1.0;  ///< yaw rate from t_x error
  double gain_yaw_1_s = 0.82;   ///< yaw rate from yaw error; control/proportional_law.h says how it is chosen
  double setpoint_t_z_m = 0.0;  ///< added to the template's distance: + follows from farther away
  double setpoint_t_x_m = 0.0;  ///< + drives to the left of the person
  double setpoint_yaw_rad =
      0.0;  ///< + moves the robot around the person to their right side, still facing them
  double deadband_distance_m = 0.05;
  bool reverse = false;           ///< may drive backwards when the person comes nearer
  double bearing_max_rad = 0.35;  ///< largest angle between the person and the optical axis
  double bearing_gain_1_s = 2.0;  ///< how fast the bearing may approach that angle
  // Comfort: limits of every law's output. The gate's own stay behind them.
  double acceleration_m_s2 = 0.6;
  double deceleration_m_s2 = 1.2;
  double jerk_m_s3 = 2.8;
  double yaw_acceleration_rad_s2 = 2.5;
  double yaw_jerk_rad_s3 = 20.0;
  // The law "trail".
  double trail_reach_m = 0.4;       ///< an offset from the trail is gone after some of these
  double trail_smooth_m = 1.4;      ///< the trail is smoothed over this far ahead and behind
  double trail_delay_s = 0.15;      ///< from a command to the motion
  double trail_bearing_rad = 0.44;  ///< as bearing_max_rad; allows for the person's own motion
  double detour_m = 0.3;            ///< how far beside the trail it passes an obstacle at most
  double search_m_s = 0.25;         ///< along the rest of the trail when the person is lost
  double search_look_rad = 0.9;     ///< to either side at the end of the trail
  double search_turn_rad_s = 0.5;
};

struct SupervisorConfig {
  std::string start = "operator";   ///< what lets the robot move: operator, or at_once (benches)
  double certainty_follow = 0.1;    ///< following starts at this certainty …
  double certainty_drop = 0.06;     ///< … and continues while it is at least this (hysteresis)
  int frames_to_follow = 3;         ///< good frames in a row before the robot moves
  double target_timeout_s = 0.4;    ///< no good frame for this long: target lost
  double frame_timeout_s = 0.3;     ///< no frame for this long: camera silent
  double sip_timeout_s = 0.5;       ///< no SIP for this long: robot silent
  double bumper_hold_s = 2.0;       ///< time at rest after a bumper or stall has cleared
  double sonar_timeout_s = 1.0;     ///< no reading of a front sonar for this long: sonars silent
  double search_s = 15.0;           ///< longest search for a lost target by a law that can drive on
  double battery_low_v = 11.0;      ///< below this the battery counts as low; 0: never
  double battery_ok_v = 12.0;       ///< at or above this it no longer does (hysteresis)
  double lateness_max_s = 0.2;      ///< a tick that is later than this: control too late; 0: never
  double operator_timeout_s = 0.0;  ///< no sign of the operator for this long: operator away; 0: never
};

struct GateConfig {
  double v_max_m_s = 0.7;
  double yaw_rate_max_rad_s = 1.0;
  double acceleration_m_s2 = 0.6;
  double deceleration_m_s2 = 1.5;
  double separation_m = 0.8;  ///< the robot does not drive nearer to the person than this, camera to back
  double clearance_m = 0.4;   ///< nor nearer than this to a sonar obstacle in its way, bumper to echo
  double yaw_acceleration_rad_s2 = 2.5;
  double command_lifetime_s = 0.2;
};

struct RobotConfig {
  std::string address = "serial:/dev/heel-robot@38400";  ///< serial:PATH@BAUD, pty:PATH@BAUD, tcp:HOST:PORT
  std::string model = "auto";  ///< the robot's subclass; auto: whatever it says that it is
  bool sonar = true;
  bool request_config = true;
  double config_wait_s = 1.0;  ///< longest wait for CONFIGpac
  double sync_retry_s = 1.0;
  double reconnect_s = 1.0;
  int v_limit_mm_s = 750;          ///< SETV
  int yaw_rate_limit_deg_s = 100;  ///< SETRV
  int acceleration_mm_s2 = 600;    ///< SETA +
  int deceleration_mm_s2 = 1500;   ///< SETA −, sent as a negative argument
  int yaw_acceleration_deg_s2 = 180;
};

struct TelemetryConfig {
  std::string directory;                          ///< empty: nothing is recorded
  std::string pictures = "none";                  ///< which are recorded: none, on_fault, jpeg, lossless
  double keep_mb = 4000.0;                        ///< of recordings in the folder; the oldest are removed
  double keep_days = 30.0;                        ///< older ones are removed
  std::string black_box = "/run/heel/black-box";  ///< what outlives a crash; empty: none
};

struct OperatorConfig {
  std::string socket = "/run/heel/control.sock";  ///< of the operators; empty: none
};

struct ViewConfig {
  std::string address;             ///< HOST:PORT that the page is served at; empty: it is not served
  std::string token_file;          ///< empty: the credential "view-token" of systemd, when there is one
  std::vector<std::string> hosts;  ///< names that browsers may reach it by, beside addresses and localhost
  double picture_hz = 15.0;        ///< largest rate of the pictures on the page
  int picture_quality = 75;        ///< of their JPEG compression
};

struct MqttConfig {
  std::string address;                ///< of the broker, tcp://HOST:PORT or ssl://HOST:PORT; empty: none
  std::string topic = "heel/{host}";  ///< the topics begin with it; {host}: this computer's name
  std::string user;                   ///< empty: the broker knows its clients by other means
  std::string password_file;          ///< empty: the credential "mqtt-password" of systemd, when there is one
  std::string ca_file;                ///< empty: the authorities that the system trusts
  double period_s = 1.0;              ///< the status is published this often, and with every change of state
};

struct RuntimeConfig {
  std::string log_level = "info";
  std::string ready_after =
      "all";             ///< when systemd receives READY: all (robot and first frame), robot, start
  bool realtime = true;  ///< request SCHED_FIFO and mlockall; when refused, warn and continue
  int priority_control = 60;
  int priority_capture = 50;
  int priority_vision = 40;
  // The processor core that the thread runs on alone; −1: any.
  int core_control = -1;
  int core_capture = -1;
  int core_vision = -1;
};

struct Config {
  CameraConfig camera;
  TargetConfig target;
  VisionConfig vision;
  EstimateConfig estimate;
  ControlConfig control;
  SupervisorConfig supervisor;
  GateConfig gate;
  RobotConfig robot;
  TelemetryConfig telemetry;
  OperatorConfig operators;
  ViewConfig view;
  MqttConfig mqtt;
  RuntimeConfig runtime;
};

}  // namespace heel
