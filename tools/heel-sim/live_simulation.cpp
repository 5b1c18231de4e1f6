#include "live_simulation.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

#include "heel/error.h"
#include "heel/time.h"
#include "realtime/clock.h"
#include "sim/contact/robot_in_world.h"
#include "sim/robot/truth_columns.h"
#include "sim/scene/sent_picture.h"
#include "sim/scene/truth_columns.h"

namespace heel::sim {
namespace {

constexpr TimeNs kTick_ns = kNsPerMs;
constexpr TimeNs kProgress_ns = 2 * kNsPerS;
constexpr double kSavedFramePeriod_s = 5.0;
constexpr int kWireDecimals = 6;

P3AtSettings robot_settings(const Options& options, const Scenario* scenario) {
  P3AtSettings settings;
  settings.boot_baud = options.boot_baud;
  settings.keeps_rate_after_close = options.after_close == "stay";
  settings.chassis.true_track_m = options.track_m;
  if (scenario != nullptr) apply_robot(scenario->robot, settings);
  if (!options.model.empty()) use_model(options.model, settings);
  if (options.exact) settings.chassis = exact_chassis(settings.chassis);
  for (const std::string& fault : options.faults) settings.faults.push_back(parse_fault(fault));
  return settings;
}

/// A reader of standard output may go away at any time: that must not end the simulation.
void print_event(TimeNs t_ns, const std::string& what) {
  std::fputs(fmt::format("{:9.3f} s  {}\n", seconds_from_ns(t_ns), what).c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

LiveSimulation::LiveSimulation(const Options& options, const Scenario* scenario)
    : robot_(robot_settings(options, scenario), options.seed),
      duration_s_(options.duration_s),
      truth_period_ns_(ns_from_seconds(1.0 / options.truth_rate_hz)) {
  OpenSink open_sink;
  if (scenario != nullptr) {
    live_world_ = std::make_unique<LiveWorld>(*scenario, robot_);
    const ScenarioCamera& camera = scenario->camera;
    if (options.camera != "none") {
      const CameraModel sent = sent_camera(camera);
      open_sink = [address = options.camera, sent, rate_hz = camera.rate_hz] {
        return open_frame_sink(address, sent.width_px, sent.height_px, rate_hz);
      };
    }
  }
  transport_ = open_transport(options.robot, options.boot_baud);
  t_start_ns_ = monotonic_now_ns();  // time 0 of robot and world: after all that takes long
  open_recordings(options);
  if (options.live_faults) live_faults_ = std::make_unique<LineInput>(STDIN_FILENO);
  if (open_sink) {
    live_world_->motion.set(robot_.truth());
    live_world_->camera =
        std::make_unique<LiveCamera>(live_world_->world, live_world_->motion, std::move(open_sink),
                                     t_start_ns_, options.saved_frames_folder, kSavedFramePeriod_s);
  }
  print_event(0, "ready at " + transport_->address());
}

void LiveSimulation::open_recordings(const Options& options) {
  ByteSink on_received;
  if (!options.wire_file.empty()) {
    wire_ = std::make_unique<WireFile>(options.wire_file, kWireDecimals);
    on_received = [this](TimeNs t_ns, std::span<const std::uint8_t> bytes) {
      wire_->write(t_start_ns_ + t_ns, bytes);
      wire_->flush();  // the file can be read while the robot runs
    };
  }
  server_ = std::make_unique<RobotServer>(robot_, *transport_, print_event, on_received);
  if (options.truth_file.empty()) return;
  truth_ = std::make_unique<SampledCsv>(options.truth_file);
  add_robot_columns();
  if (live_world_) add_world_columns();
}

void LiveSimulation::add_robot_columns() {
  truth_->add_column("t_s", 3, [this] { return seconds_from_ns(robot_.truth().t_ns); });
  for (const auto& columns : {robot_motion_columns(), robot_state_columns()})
    for (const RobotTruthColumn& column : columns)
      truth_->add_column(column.name, column.decimals,
                         [this, &column] { return column.value(robot_.truth()); });
}

void LiveSimulation::add_world_columns() {
  truth_->add_column("t_monotonic_s", 6,
                     [this] { return seconds_from_ns(robot_.truth().t_ns + t_start_ns_); });
  bool is_first = true;
  for (const TruthColumn& column : world_truth_columns()) {
    // The first column computes the world's truth for the whole row.
    truth_->add_column(column.name, column.decimals, [this, &column, is_first] {
      const RobotTruth robot = robot_.truth();
      if (is_first)
        live_world_->truth =
            live_world_->world.truth(robot_motion_from_truth(robot), seconds_from_ns(robot.t_ns));
      return column.value(live_world_->truth);
    });
    is_first = false;
  }
}

void LiveSimulation::run(const volatile std::sig_atomic_t& stop) {
  while (stop == 0) {
    const TimeNs t_ns = monotonic_now_ns() - t_start_ns_;
    if (live_faults_) begin_live_faults(t_ns);
    server_->receive(t_ns);
    if (truth_) write_truth_rows(t_ns);
    server_->advance(t_ns);
    if (live_world_) step_world(t_ns);
    if (duration_s_ > 0.0 && seconds_from_ns(t_ns) >= duration_s_) break;
    sleep_until_ns(t_start_ns_ + t_ns + kTick_ns);
  }
  if (truth_) truth_->flush();
}

/// A line that cannot be used is named and left out; the next one counts.
void LiveSimulation::begin_live_faults(TimeNs t_ns) {
  for (const std::string& line : live_faults_->lines()) {
    try {
      begin_live_fault(line, t_ns);
    } catch (const Error& error) {
      std::fprintf(stderr, "heel-sim: %s\n", error.what());
    }
  }
}

void LiveSimulation::begin_live_fault(const std::string& line, TimeNs t_ns) {
  if (!line.starts_with("camera+")) return robot_.inject(parse_fault_now(line, t_ns));
  if (!live_world_ || !live_world_->camera)
    throw Error("fault '" + line + "': there is no camera (expected --scenario and --camera)");
  live_world_->camera->take_away(parse_fault_duration(line));
}

/// Rows have equal distances in time, also when this process was delayed.
void LiveSimulation::write_truth_rows(TimeNs t_ns) {
  for (; t_next_row_ns_ <= t_ns; t_next_row_ns_ += truth_period_ns_) {
    robot_.advance(t_next_row_ns_);
    truth_->write_row();
  }
}

void LiveSimulation::step_world(TimeNs t_ns) {
  live_world_->contact.step(seconds_from_ns(t_ns));
  hold_walk_while_robot_is_far(robot_.truth(), seconds_from_ns(t_ns), seconds_from_ns(t_ns - t_stepped_ns_),
                               live_world_->world);
  t_stepped_ns_ = t_ns;
  const RobotTruth robot = robot_.truth();
  live_world_->motion.set(robot);
  if (start_walk_when_motors_run(robot, seconds_from_ns(robot.t_ns), live_world_->world))
    print_event(robot.t_ns, fmt::format("motors on: the person sets off in {:.1f} s",
                                        live_world_->world.scenario().walk_after_s));
  if (t_ns < t_next_progress_ns_) return;
  print_progress(t_ns);
  t_next_progress_ns_ += kProgress_ns;
}

void LiveSimulation::print_progress(TimeNs t_ns) const {
  const RobotTruth robot = robot_.truth();
  const Truth truth = live_world_->world.truth(robot_motion_from_truth(robot), seconds_from_ns(t_ns));
  print_event(t_ns,
              fmt::format("robot ({:6.2f}, {:6.2f}) {:.2f} m/s   person ({:6.2f}, {:6.2f}) {:.2f} m ahead{}",
                          robot.pose.x_m, robot.pose.y_m, robot.v_m_s, truth.person.x_m, truth.person.y_m,
                          truth.back_in_camera_m.z(), truth.in_view ? "" : ", OUT OF VIEW"));
}

void LiveSimulation::print_camera_counters() const {
  if (!live_world_ || !live_world_->camera) return;
  const LiveCameraCounters c = live_world_->camera->counters();
  std::fputs(fmt::format("camera: {} frames, {} left out, {} dropped by the scenario, {:.1f} ms to draw one "
                         "(longest {:.1f} ms)\n",
                         c.frames, c.frames_late, c.frames_dropped, c.draw_ms_mean, c.draw_ms_max)
                 .c_str(),
             stdout);
}

}  // namespace heel::sim
