#include "daemon/daemon.h"

#include <spdlog/spdlog.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

#include "capture/factory/frame_source_factory.h"
#include "capture/frame_source.h"
#include "config/config_load.h"
#include "daemon/capture_loop.h"
#include "daemon/check.h"
#include "daemon/control_loop.h"
#include "daemon/inputs.h"
#include "daemon/service_notifier.h"
#include "daemon/signals.h"
#include "daemon/vision_loop.h"
#include "heel/error.h"
#include "logging/logging.h"
#include "realtime/schedule.h"
#include "telemetry/telemetry.h"

namespace heel {
namespace {

constexpr TimeNs kMainPeriod_ns = 100 * kNsPerMs;
constexpr TimeNs kControlMustBeat_ns = 500 * kNsPerMs;  // older: systemd's watchdog is not fed
constexpr TimeNs kReloadTimeout_ns = kNsPerS;
constexpr TimeNs kRestTimeout_ns = 3 * kNsPerS;  // a file camera has ended: this long to come to rest

class Daemon {
 public:
  Daemon(LoadedConfig loaded, Signals& signals);
  int run();

 private:
  void announce() const;
  void start();
  void stop();
  void start_thread(std::thread& thread, ThreadRole role, std::function<void()> body);
  void reload();
  void service_watchdog(TimeNs now_ns);
  void log_link_errors();
  bool robot_has_answered() const;
  bool ready_by_now() const;
  void log_counters() const;
  bool finished_and_stopped(TimeNs now_ns);
  std::string status_line() const;

  LoadedConfig loaded_;
  Inputs inputs_;
  Signals& signals_;
  ServiceNotifier notifier_;

  TelemetryFeeds feeds_;
  FrameTripleBuffer frames_;
  Mailbox<PoseEstimate> poses_;
  std::unique_ptr<FrameSource> source_;
  PoseTracker tracker_;
  CaptureLoop capture_;
  VisionLoop vision_;
  ControlLoop control_;
  Telemetry telemetry_;
  std::thread control_thread_, vision_thread_, capture_thread_, telemetry_thread_;

  TickRecord status_;
  bool ready_ = false;     // and systemd has been told
  bool complete_ = false;  // robot and camera have both been here
  std::uint64_t seen_open_failures_ = 0;
  std::string logged_open_error_;  // empty: none since the robot last answered
  TimeNs t_ended_ns_ = 0;          // when a file camera's last frame was given; 0: not yet
  std::atomic<bool> failed_{false};
};

Daemon::Daemon(LoadedConfig loaded, Signals& signals)
    : loaded_(std::move(loaded)),
      inputs_(load_inputs(loaded_.config)),
      signals_(signals),
      frames_(static_cast<std::uint32_t>(inputs_.camera.width_px),
              static_cast<std::uint32_t>(inputs_.camera.height_px)),
      source_(make_frame_source(loaded_.config.camera)),
      tracker_(inputs_.shirt, inputs_.camera, loaded_.config.vision),
      capture_(*source_, frames_, feeds_.captures, feeds_.capture_events,
               CaptureLoopSettings{.begin_again = loaded_.config.camera.at_end == "loop"}),
      vision_(frames_, tracker_, poses_, feeds_.poses),
      control_(loaded_.config, poses_, feeds_),
      telemetry_(feeds_, loaded_.config.telemetry) {}

void Daemon::announce() const {
  const Config& c = loaded_.config;
  spdlog::info("configuration: {}", loaded_.file);
  spdlog::info("camera: {}, calibrated by {}, {}×{} pixels", c.camera.source, c.camera.info,
               inputs_.camera.width_px, inputs_.camera.height_px);
  spdlog::info("template: {}, taken at {:.2f} m; {}", c.target.shirt, inputs_.shirt.distance_m,
               verdict_line(inputs_.verdict));
  spdlog::info("robot: {}", c.robot.address);
  spdlog::info(
      "limits: {:.2f} m/s, {:.2f} rad/s, {:.2f} m/s² up and {:.2f} down, no nearer than {:.2f} m to the "
      "person and "
      "{}; {}; a command lives {:.2f} s",
      c.gate.v_max_m_s, c.gate.yaw_rate_max_rad_s, c.gate.acceleration_m_s2, c.gate.deceleration_m_s2,
      c.gate.separation_m,
      c.robot.sonar ? fmt::format("{:.2f} m to what the sonars hear", c.gate.clearance_m) : "without sonars",
      c.control.reverse ? "may reverse" : "no reverse", c.gate.command_lifetime_s);
}

int Daemon::run() {
  announce();
  start();
  bool stop_asked = false;
  while (!stop_asked && !failed_ && !finished_and_stopped(monotonic_now_ns())) {
    const Signal signal = signals_.wait(kMainPeriod_ns);
    if (signal == Signal::Reload) reload();
    stop_asked = signal == Signal::Stop;
    service_watchdog(monotonic_now_ns());
  }
  if (stop_asked) spdlog::info("asked to stop");
  stop();
  return failed_ ? 1 : 0;
}

void Daemon::start_thread(std::thread& thread, ThreadRole role, std::function<void()> body) {
  const ThreadPlan plan = plan_of(make_schedule(loaded_.config), role);
  thread = std::thread([this, plan, body = std::move(body)] {
    try {
      enter_thread(plan, loaded_.config.runtime.realtime);
      body();
    } catch (const std::exception& error) {
      spdlog::critical("{}: {}", plan.name, error.what());
      failed_ = true;
    }
  });
}

void Daemon::start() {
  if (loaded_.config.runtime.realtime) lock_process_memory();
  // Telemetry first, to write down what the others say; control before the picture, to reach the robot early.
  start_thread(telemetry_thread_, ThreadRole::Telemetry, [this] { telemetry_.run(); });
  start_thread(control_thread_, ThreadRole::Control, [this] { control_.run(); });
  start_thread(vision_thread_, ThreadRole::Vision, [this] { vision_.run(); });
  start_thread(capture_thread_, ThreadRole::Capture, [this] { capture_.run(); });
}

void Daemon::stop() {
  notifier_.stopping();
  control_.stop();
  control_thread_.join();
  control_.shut_robot_down();  // in case its thread ended by an exception
  capture_.stop();
  vision_.stop();
  capture_thread_.join();
  vision_thread_.join();
  telemetry_.stop();
  telemetry_thread_.join();
  log_counters();
  spdlog::info("stopped; the robot is closed");
}

/// All or nothing.
void Daemon::reload() {
  notifier_.reloading(monotonic_now_ns());
  try {
    LoadedConfig fresh = load_config(loaded_.file);
    check_against_camera(fresh.config, inputs_.camera);
    const auto fixed = keys_needing_restart(loaded_.config, fresh.config);
    for (const auto& key : fixed) spdlog::error("{}: {} cannot change while running", loaded_.file, key);
    if (!fixed.empty()) {
      spdlog::error("reload refused: restart heeld to change what cannot change while running");
    } else if (!control_.reconfigure(fresh.config, kReloadTimeout_ns)) {
      spdlog::error("reload refused: control did not take it over");
    } else {
      set_log_level(fresh.config.runtime.log_level);
      loaded_ = std::move(fresh);
      spdlog::info("reloaded {}", loaded_.file);
    }
  } catch (const ConfigError& error) {
    for (const auto& line : error.lines()) spdlog::error("{}", line);
    spdlog::error("reload refused: the old configuration stays");
  } catch (const Error& error) {
    spdlog::error("{}", error.what());
    spdlog::error("reload refused: the old configuration stays");
  }
  if (ready_) notifier_.ready();
}

void Daemon::service_watchdog(TimeNs now_ns) {
  control_.take_status(status_);
  log_link_errors();
  if (!complete_ && robot_has_answered() && frames_.captured() > 0) {
    complete_ = true;
    spdlog::info("the robot has answered and the first frame is here");
  }
  if (!ready_ && ready_by_now()) {
    ready_ = true;
    notifier_.ready();
    spdlog::info("ready");
  }
  notifier_.status(status_line());
  if (now_ns - control_.heartbeat_ns() < kControlMustBeat_ns) notifier_.alive(now_ns);
  if (capture_.ended() && t_ended_ns_ == 0) t_ended_ns_ = now_ns;
}

void Daemon::log_link_errors() {
  if (robot_has_answered()) logged_open_error_.clear();
  const std::uint64_t failures = control_.open_failures();
  if (failures == seen_open_failures_) return;
  seen_open_failures_ = failures;
  // Once for each reason in an outage, not for each attempt.
  std::string error = control_.last_open_error();
  if (error == logged_open_error_) return;
  spdlog::warn("{}", error);
  logged_open_error_ = std::move(error);
}

bool Daemon::robot_has_answered() const {
  const LinkPhase phase = status_.robot.phase;
  return status_.robot.has_sip && (phase == LinkPhase::Running || phase == LinkPhase::Disabled);
}

bool Daemon::ready_by_now() const {
  const std::string& after = loaded_.config.runtime.ready_after;
  return complete_ || after == "start" || (after == "robot" && robot_has_answered());
}

/// What came over both lines and what was lost on them, once, at the end.
void Daemon::log_counters() const {
  const CaptureCounters frames = capture_.counters();
  spdlog::info(
      "camera: {} frames, {} dropped by the driver, {} overtaken by fresher ones; opened again {} times",
      frames.captured, frames.dropped_by_driver, frames.dropped_unread, frames.reopened);
  const RobotState robot = telemetry_.snapshot().tick.robot;
  spdlog::info(
      "robot: {} packets, {} with a wrong checksum or length, {} bytes discarded; connected again {} times",
      robot.sips, robot.checksum_errors, robot.bytes_discarded, robot.reconnects);
}

/// A file camera has ended, and the wheels have been brought to rest.
bool Daemon::finished_and_stopped(TimeNs now_ns) {
  if (t_ended_ns_ == 0) return false;
  const bool resting = status_.stop_reason != StopReason::None && status_.command.v_m_s == 0.0 &&
                       status_.command.yaw_rate_rad_s == 0.0;
  return resting || now_ns - t_ended_ns_ > kRestTimeout_ns;
}

std::string Daemon::status_line() const {
  if (!complete_) {
    std::string line = "waiting for";
    if (!robot_has_answered()) line += " the robot (" + std::string(to_string(status_.robot.phase)) + ")";
    if (frames_.captured() == 0) line += " the camera";
    return line;
  }
  if (status_.stop_reason == StopReason::None) return "following";
  return std::string("at rest: ") + to_string(status_.stop_reason);
}

}  // namespace

int run_daemon(const std::string& config_path) {
  LoadedConfig loaded = load_config(config_path);
  // Before anything that starts a thread (logging and OpenCV do): a thread that does not block SIGTERM would
  // take it, and the process would end with the wheels turning.
  Signals signals;
  start_logging(loaded.config.runtime.log_level);
  int status = 1;
  try {
    status = Daemon(std::move(loaded), signals).run();
  } catch (...) {
    stop_logging();
    throw;
  }
  stop_logging();
  return status;
}

}  // namespace heel
