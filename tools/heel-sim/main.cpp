// heel-sim: a P3-AT on a pty or a TCP port, in real time, for any client that speaks ARCOS; with a scenario
// also its world: a walking person, and the camera's frames for readers of "sim:NAME".
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "files/camera_info.h"
#include "heel/camera_model.h"
#include "heel/error.h"
#include "heel/time.h"
#include "realtime/clock.h"
#include "sim/contact/contact.h"
#include "sim/live/live_camera.h"
#include "sim/live/still.h"
#include "sim/robot/p3at.h"
#include "sim/scene/truth_columns.h"
#include "sim/scene/world.h"
#include "sim/transport/robot_server.h"
#include "sim/transport/transport.h"
#include "sim/transport/truth_csv.h"
#include "sim/transport/wire_file.h"

namespace {

using namespace heel;
using namespace heel::sim;

constexpr TimeNs kTick_ns = kNsPerMs;
constexpr TimeNs kProgress_ns = 2 * kNsPerS;
constexpr double kKeptFrame_s = 5.0;

volatile std::sig_atomic_t g_stop = 0;
void on_signal(int) {
  g_stop = 1;
}

struct Options {
  std::string robot;
  std::string model = "p3at-sh";
  std::string truth;
  std::string wire;
  double truth_rate_hz = 50.0;
  int boot_baud = 9600;
  double track_m = ChassisSettings{}.true_track_m;
  bool exact = false;
  std::uint64_t seed = 1;
  std::vector<std::string> faults;
  double duration_s = 0.0;
  std::string scenario;
  std::string camera = "none";
  std::string frames;
  std::string still;
  double still_distance_m = 1.5;
  std::string camera_info;
};

void add_options(CLI::App& app, Options& options) {
  app.add_option("--robot", options.robot, "where clients find it: pty:PATH, tcp:PORT or tcp:HOST:PORT");
  app.add_option("--model", options.model, "p3at-sh (1 mm a position unit) or p3at (0.465 mm)")
      ->check(CLI::IsMember({"p3at-sh", "p3at"}))
      ->capture_default_str();
  app.add_option("--boot-baud", options.boot_baud, "rate of the robot's port after power-on")
      ->check(CLI::IsMember({9600, 19200, 38400, 57600, 115200}))
      ->capture_default_str();
  app.add_option("--track", options.track_m, "the floor: true turning track in m (odometry believes 0.588)")
      ->check(CLI::Range(0.4, 1.0))
      ->capture_default_str();
  app.add_flag("--exact", options.exact, "no slip, no scale error, no drift: odometry is the truth");
  app.add_option(
      "--fault", options.faults,
      "KIND@START[+DURATION][=AMOUNT], times in s; may be repeated. " + ("Kinds: " + fault_names()));
  app.add_option("--seed", options.seed, "of drift and line faults")->capture_default_str();
  app.add_option("--truth", options.truth, "write the true motion to this CSV file");
  app.add_option("--truth-rate", options.truth_rate_hz, "rows a second")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  app.add_option("--wire", options.wire,
                 "write what the client sends to this file: CLOCK_MONOTONIC seconds and bytes in hex, a line "
                 "each time some arrive");
  app.add_option("--duration", options.duration_s, "end after this many seconds; 0: on SIGINT or SIGTERM")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--scenario", options.scenario, "the world: a scenario file (TOML)");
  app.add_option("--camera", options.camera,
                 "sim:NAME: frames for readers of that address; v4l2:/dev/videoN: into a v4l2loopback "
                 "device; file:PICTURE.pgm: each in its turn is that file; or none")
      ->capture_default_str();
  app.add_option("--frames", options.frames, "keep a frame every five seconds in this folder");
  app.add_option("--still", options.still,
                 "write the view to teach from (.png), print its region, and go on only if --robot is given");
  app.add_option("--distance", options.still_distance_m, "of that view, metres")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  app.add_option("--camera-info-out", options.camera_info, "write the scenario's camera as camera_info YAML");
}

P3AtSettings robot_settings(const Options& options, const Scenario* scenario) {
  P3AtSettings settings = options.model == "p3at" ? p3at_h8_settings() : P3AtSettings{};
  settings.boot_baud = options.boot_baud;
  settings.chassis.true_track_m = options.track_m;
  if (scenario != nullptr) {
    settings.start = {scenario->robot.x_m, scenario->robot.y_m, scenario->robot.heading_rad};
    settings.chassis.true_track_m = scenario->robot.true_track_m;
    settings.chassis.left_scale_error = scenario->robot.left_scale_error;
    settings.chassis.right_scale_error = scenario->robot.right_scale_error;
    for (const std::string& fault : scenario->robot.faults) settings.faults.push_back(parse_fault(fault));
  }
  if (options.exact) settings.chassis = exact_chassis();
  for (const std::string& fault : options.faults) settings.faults.push_back(parse_fault(fault));
  return settings;
}

void print_event(TimeNs t_ns, const std::string& what) {
  std::printf("%9.3f s  %s\n", seconds_from_ns(t_ns), what.c_str());
  std::fflush(stdout);
}

/// Everything of the world side; absent without a scenario.
struct Surroundings {
  Surroundings(const Scenario& scenario, P3At& robot) : world(scenario), contact(world, robot) {}

  World world;
  Contact contact;
  SharedMotion motion;
  std::unique_ptr<LiveCamera> camera;
  Truth truth;  ///< of the row being written
};

/// The person sets off a little after the robot's motors come on.
void start_walk_when_motors_run(const RobotTruth& robot, World& world) {
  if (world.walking() || !robot.motors_enabled) return;
  const double t_walk_s = seconds_from_ns(robot.t_ns) + world.scenario().walk_after_s;
  world.start_walk(t_walk_s);
  print_event(robot.t_ns, "motors on: the person sets off in " +
                              std::to_string(world.scenario().walk_after_s).substr(0, 3) + " s");
}

void add_world_columns(TruthCsv& truth, Surroundings& surroundings, const P3At& robot, TimeNs t_start_ns) {
  truth.column("t_monotonic_s", 6,
               [&robot, t_start_ns] { return seconds_from_ns(robot.truth().t_ns + t_start_ns); });
  bool first = true;
  for (const TruthColumn& column : world_truth_columns()) {
    // The first column of a row takes the world's truth at that moment for all of them.
    truth.column(column.name, column.decimals, [&surroundings, &robot, &column, first] {
      if (first) {
        const RobotTruth now = robot.truth();
        surroundings.truth = surroundings.world.truth(
            {now.pose.x_m, now.pose.y_m, now.pose.heading_rad, now.v_m_s, now.yaw_rate_rad_s},
            seconds_from_ns(now.t_ns));
      }
      return column.value(surroundings.truth);
    });
    first = false;
  }
}

void print_progress(TimeNs t_ns, const P3At& robot, const Surroundings& surroundings) {
  const RobotTruth now = robot.truth();
  const Truth truth = surroundings.world.truth(
      {now.pose.x_m, now.pose.y_m, now.pose.heading_rad, now.v_m_s, now.yaw_rate_rad_s},
      seconds_from_ns(t_ns));
  char text[160];
  std::snprintf(text, sizeof text, "robot (%6.2f, %6.2f) %.2f m/s   person (%6.2f, %6.2f) %.2f m ahead%s",
                now.pose.x_m, now.pose.y_m, now.v_m_s, truth.person.x_m, truth.person.y_m,
                truth.back_in_camera_m.z(), truth.in_view ? "" : ", OUT OF VIEW");
  print_event(t_ns, text);
}

/// Real time, tick by tick, until a signal or the end of the run.
void run(P3At& robot, RobotServer& server, TruthCsv* truth, Surroundings* surroundings, TimeNs t_start_ns,
         const Options& options) {
  const TimeNs row_ns = ns_from_seconds(1.0 / options.truth_rate_hz);
  TimeNs t_row_ns = 0;
  TimeNs t_progress_ns = 0;
  while (g_stop == 0) {
    const TimeNs t_ns = monotonic_now_ns() - t_start_ns;
    server.listen(t_ns);
    // Rows stand at even times also where this process was held up.
    for (; truth != nullptr && t_row_ns <= t_ns; t_row_ns += row_ns) {
      robot.advance(t_row_ns);
      truth->write_row();
    }
    server.speak(t_ns);
    if (surroundings != nullptr) {
      surroundings->contact.step(seconds_from_ns(t_ns));
      surroundings->motion.set(robot.truth());
      start_walk_when_motors_run(robot.truth(), surroundings->world);
      if (t_ns >= t_progress_ns) {
        print_progress(t_ns, robot, *surroundings);
        t_progress_ns += kProgress_ns;
      }
    }
    if (options.duration_s > 0.0 && seconds_from_ns(t_ns) >= options.duration_s) break;
    sleep_until_ns(t_start_ns + t_ns + kTick_ns);
  }
}

/// What needs no robot: the still, the camera file.
void write_files(const Options& options, const Scenario& scenario) {
  if (!options.camera_info.empty()) write_camera_model(scenario.camera.model, options.camera_info);
  if (!options.still.empty()) write_still(scenario, options.still, options.still_distance_m);
}

void check(const Options& options) {
  const bool needs_world = options.camera != "none" || !options.still.empty() || !options.camera_info.empty();
  if (needs_world && options.scenario.empty())
    throw Error("--scenario: missing (expected a scenario file for --camera, --still and --camera-info-out)");
  if (options.robot.empty() && options.still.empty() && options.camera_info.empty())
    throw Error("--robot: missing (expected pty:PATH, tcp:PORT or tcp:HOST:PORT)");
}

void simulate(const Options& options, const Scenario* scenario) {
  P3At robot(robot_settings(options, scenario), options.seed);
  std::unique_ptr<Surroundings> surroundings;
  if (scenario != nullptr) surroundings = std::make_unique<Surroundings>(*scenario, robot);
  std::unique_ptr<FrameSink> sink;
  if (scenario != nullptr && options.camera != "none") {
    const ScenarioCamera& camera = scenario->camera;
    sink = open_frame_sink(options.camera, camera.model.width_px, camera.model.height_px, camera.rate_hz);
  }
  const std::unique_ptr<Transport> transport = open_transport(options.robot, options.boot_baud);
  const TimeNs t_start_ns = monotonic_now_ns();
  std::unique_ptr<WireFile> wire;
  ByteSink on_received;
  if (!options.wire.empty()) {
    wire = std::make_unique<WireFile>(options.wire);
    on_received = [&wire, t_start_ns](TimeNs t_ns, std::span<const std::uint8_t> bytes) {
      wire->write(t_start_ns + t_ns, bytes);
    };
  }
  RobotServer server(robot, *transport, print_event, on_received);
  std::unique_ptr<TruthCsv> truth;
  if (!options.truth.empty()) {
    truth = std::make_unique<TruthCsv>(options.truth);
    add_robot_columns(*truth, robot);
    if (surroundings) add_world_columns(*truth, *surroundings, robot, t_start_ns);
  }
  if (surroundings && sink) {
    surroundings->motion.set(robot.truth());
    surroundings->camera = std::make_unique<LiveCamera>(
        surroundings->world, surroundings->motion, std::move(sink), t_start_ns, options.frames, kKeptFrame_s);
  }
  print_event(0, "ready at " + transport->address());
  run(robot, server, truth.get(), surroundings.get(), t_start_ns, options);
  if (surroundings && surroundings->camera) {
    const LiveCameraCounters c = surroundings->camera->counters();
    std::printf(
        "camera: %llu frames, %llu left out, %llu dropped as the scenario has it, %.1f ms to draw one (worst "
        "%.1f ms)\n",
        static_cast<unsigned long long>(c.frames), static_cast<unsigned long long>(c.frames_late),
        static_cast<unsigned long long>(c.frames_dropped), c.draw_ms_mean, c.draw_ms_worst);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("heel-sim: a simulated P3-AT for any ARCOS client, and the world it follows a person through");
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, on_signal);
  std::signal(SIGPIPE, SIG_IGN);  // whoever read our events may go; the symlink must not stay
  try {
    check(options);
    std::unique_ptr<Scenario> scenario;
    if (!options.scenario.empty()) {
      scenario = std::make_unique<Scenario>(read_scenario(options.scenario));
      if (app.count("--seed") > 0) scenario->seed = options.seed;
      write_files(options, *scenario);
    }
    if (!options.robot.empty()) simulate(options, scenario.get());
  } catch (const Error& error) {
    std::fprintf(stderr, "heel-sim: %s\n", error.what());
    return 1;
  }
  return 0;
}
