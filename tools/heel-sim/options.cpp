#include "options.h"

#include "heel/error.h"
#include "models/robot_models.h"
#include "sim/robot/fault.h"

namespace heel::sim {
namespace {

void add_robot_options(CLI::App& app, Options& options) {
  app.add_option("--robot", options.robot, "where clients find it: pty:PATH, tcp:PORT or tcp:HOST:PORT")
      ->type_name("ADDRESS");
  std::vector<std::string> models;
  for (const RobotModel& model : robot_models()) models.push_back(model.subclass);
  app.add_option("--model", options.model,
                 "the robot: its units, outline, sonars and name (default: the scenario's, else p3at-sh)")
      ->type_name("MODEL")
      ->check(CLI::IsMember(models));
  app.add_option("--boot-baud", options.boot_baud, "rate of the robot's port after power-on")
      ->type_name("BAUD")
      ->check(CLI::IsMember({9600, 19200, 38400, 57600, 115200}))
      ->capture_default_str();
  app.add_option(
         "--after-close", options.after_close,
         "rate of the robot's port after CLOSE: fall-back (to --boot-baud) or stay. Sources disagree about "
         "real robots")
      ->check(CLI::IsMember({"fall-back", "stay"}))
      ->capture_default_str();
  app.add_option("--track", options.track_m,
                 "true turning track of a P3-AT on this floor, m (its firmware's odometry uses 0.588); other "
                 "robots' in proportion")
      ->type_name("M")
      ->check(CLI::Range(0.4, 1.0))
      ->capture_default_str();
  app.add_flag("--exact", options.exact, "no slip, no scale error, no drift: odometry is the truth");
  app.add_option("--fault", options.faults,
                 "KIND@START[+DURATION][=AMOUNT], times in s; may be repeated. Kinds: " + fault_names())
      ->type_name("FAULT");
  app.add_flag("--live-faults", options.live_faults,
               "read further faults from standard input while it runs, one a line: KIND[+DURATION][=AMOUNT], "
               "which begins at once; and camera+DURATION, for which there is no camera");
  app.add_option("--seed", options.seed,
                 "of the robot's drift and the line's faults; with a scenario, also replaces its seed")
      ->type_name("N")
      ->capture_default_str();
}

void add_recording_options(CLI::App& app, Options& options) {
  app.add_option("--truth", options.truth_file, "write the true motion to this CSV file")
      ->type_name("TRUTH.csv");
  app.add_option("--truth-rate", options.truth_rate_hz, "rows a second")
      ->type_name("HZ")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  app.add_option("--wire", options.wire_file,
                 "write what the client sends to this file: CLOCK_MONOTONIC seconds and bytes in hex, a line "
                 "for each piece received")
      ->type_name("FILE");
  app.add_option("--duration", options.duration_s, "end after this many seconds; 0: on SIGINT or SIGTERM")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber);
}

void add_world_options(CLI::App& app, Options& options) {
  app.add_option("--scenario", options.scenario_file, "the world: a scenario file (TOML)")
      ->type_name("SCENARIO");
  app.add_option("--camera", options.camera,
                 "where frames go. sim:NAME: to readers of that address; v4l2:/dev/videoN: into a "
                 "v4l2loopback device; file:PICTURE.pgm: into that file, each frame replacing the last; none")
      ->type_name("SPEC")
      ->capture_default_str();
  app.add_option("--frames", options.saved_frames_folder, "save a frame every five seconds in this folder")
      ->type_name("DIR");
  app.add_option("--still", options.reference_picture,
                 "write the view to make a template from (.png) and print its region; the robot is simulated "
                 "only if --robot is given")
      ->type_name("P.png");
  app.add_option("--distance", options.reference_distance_m, "of that view, metres")
      ->type_name("M")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  app.add_option("--camera-info-out", options.camera_info_file,
                 "write the scenario's camera as camera_info YAML")
      ->type_name("CAM.yaml");
}

}  // namespace

void add_options(CLI::App& app, Options& options) {
  add_robot_options(app, options);
  add_recording_options(app, options);
  add_world_options(app, options);
}

void check_options(const Options& options) {
  const bool writes_files = !options.reference_picture.empty() || !options.camera_info_file.empty();
  if ((options.camera != "none" || writes_files) && options.scenario_file.empty())
    throw Error("--scenario: missing (expected a scenario file for --camera, --still and --camera-info-out)");
  if (options.robot.empty() && !writes_files)
    throw Error("--robot: missing (expected pty:PATH, tcp:PORT or tcp:HOST:PORT)");
}

}  // namespace heel::sim
