#include "daemon/daemon.h"

#include <spdlog/spdlog.h>

#include <atomic>
#include <cstring>
#include <functional>
#include <memory>
#include <thread>

#include "capture/factory/frame_source_factory.h"
#include "capture/frame_source.h"
#include "config/config_load.h"
#include "daemon/capture_loop.h"
#include "daemon/control_loop.h"
#include "daemon/inputs.h"
#include "daemon/loop_thread.h"
#include "daemon/reload.h"
#include "daemon/signals.h"
#include "daemon/status_reporter.h"
#include "daemon/vision_loop.h"
#include "logging/logging.h"
#include "realtime/clock.h"
#include "realtime/schedule.h"
#include "telemetry/telemetry.h"
#include "vision/pose/template_selector.h"

namespace heel {
namespace {

constexpr TimeNs kMainPeriod_ns = 100 * kNsPerMs;
constexpr TimeNs kRestTimeout_ns = 3 * kNsPerS;  // for coming to rest after the end of a file camera

class Daemon {
 public:
  Daemon(LoadedConfig loaded, Signals& signals);
  int run();

 private:
  void start();
  std::thread start_thread(ThreadRole role, std::function<void()> loop);
  void serve_until_stopped();
  void reload();
  bool finished_and_stopped(TimeNs now_ns);
  void stop();
  void log_counters() const;

  LoadedConfig loaded_;
  Inputs inputs_;
  Signals& signals_;
  StatusReporter status_;

  TelemetryQueues queues_;
  FrameTripleBuffer frames_;
  Mailbox<PoseEstimate> poses_;
  std::unique_ptr<FrameSource> source_;
  TemplateSelector templates_;
  CaptureLoop capture_;
  VisionLoop vision_;
  ControlLoop control_;
  Telemetry telemetry_;
  std::thread capture_thread_, vision_thread_, control_thread_, telemetry_thread_;

  TimeNs t_ended_ns_ = 0;            // when a file camera gave its last frame; 0: not yet
  std::atomic<bool> failed_{false};  // a thread has ended by an exception
};

}  // namespace

// Load.
int run_daemon(const std::string& config_path) {
  LoadedConfig loaded = load_config(config_path);
  // Before anything that starts a thread (logging and OpenCV do): a thread that does not block SIGTERM would
  // receive it, and the process would end with the wheels turning.
  Signals signals;
  start_logging(loaded.config.runtime.log_level);
  int exit_status = 1;
  try {
    exit_status = Daemon(std::move(loaded), signals).run();
  } catch (...) {
    stop_logging();
    throw;
  }
  stop_logging();
  return exit_status;
}

// Wire.
Daemon::Daemon(LoadedConfig loaded, Signals& signals)
    : loaded_(std::move(loaded)),
      inputs_(load_inputs(loaded_.config)),
      signals_(signals),
      status_(loaded_.config.runtime),
      frames_(static_cast<std::uint32_t>(inputs_.camera.width_px),
              static_cast<std::uint32_t>(inputs_.camera.height_px)),
      source_(make_frame_source(loaded_.config.camera)),
      templates_(inputs_.shirts, inputs_.camera, loaded_.config.vision),
      capture_(*source_, frames_, queues_.captures, queues_.capture_events,
               {.restart_at_end = loaded_.config.camera.at_end == "loop"}),
      vision_(frames_, templates_, poses_, queues_.poses),
      control_(loaded_.config, poses_, queues_),
      telemetry_(queues_, loaded_.config.telemetry) {}

int Daemon::run() {
  log_configuration(loaded_, inputs_);
  start();
  serve_until_stopped();
  stop();
  return failed_ ? 1 : 0;
}

// Start.
void Daemon::start() {
  if (loaded_.config.runtime.realtime) {
    if (const int error = lock_process_memory(); error != 0) {
      spdlog::warn(
          "locking the memory was refused ({}); page faults may delay control; "
          "set LimitMEMLOCK=infinity or grant CAP_IPC_LOCK",
          std::strerror(error));
    }
  }
  // Telemetry first, to record what the others report; control before capture, to connect to the robot early.
  telemetry_thread_ = start_thread(ThreadRole::Telemetry, [this] { telemetry_.run(); });
  control_thread_ = start_thread(ThreadRole::Control, [this] { control_.run(); });
  vision_thread_ = start_thread(ThreadRole::Vision, [this] { vision_.run(); });
  capture_thread_ = start_thread(ThreadRole::Capture, [this] { capture_.run(); });
}

std::thread Daemon::start_thread(ThreadRole role, std::function<void()> loop) {
  const ThreadPlan plan = plan_of(make_schedule(loaded_.config), role);
  return start_loop_thread(plan, loaded_.config.runtime.realtime, std::move(loop), failed_);
}

// Run.
void Daemon::serve_until_stopped() {
  while (!failed_ && !finished_and_stopped(monotonic_now_ns())) {
    const Signal signal = signals_.wait(kMainPeriod_ns);
    if (signal == Signal::Reload) reload();
    status_.update(control_, frames_.captured() > 0, monotonic_now_ns());
    if (signal == Signal::Stop) {
      spdlog::info("stop signal received");
      return;
    }
  }
}

void Daemon::reload() {
  status_.reload_started(monotonic_now_ns());
  if (reload_configuration(loaded_, inputs_.camera, control_)) {
    spdlog::info("reloaded {}", loaded_.file);
  } else {
    spdlog::error("reload refused: the old configuration stays in use");
  }
  status_.reload_ended();
}

/// True: a file camera has ended, and the robot has been brought to rest.
bool Daemon::finished_and_stopped(TimeNs now_ns) {
  if (!capture_.ended()) return false;
  if (t_ended_ns_ == 0) t_ended_ns_ = now_ns;
  return status_.at_rest() || now_ns - t_ended_ns_ > kRestTimeout_ns;
}

// Stop.
void Daemon::stop() {
  status_.stopping();
  control_.stop();
  control_thread_.join();
  control_.shut_robot_down();  // in case its thread ended by an exception
  capture_.stop();
  vision_.stop();
  capture_thread_.join();
  vision_thread_.join();
  telemetry_.stop();
  telemetry_thread_.join();
  status_.send_kept();
  log_counters();
  spdlog::info("heeld stopped");
}

void Daemon::log_counters() const {
  const CaptureCounters frames = capture_.counters();
  spdlog::info(
      "camera: {} frames, {} dropped by the driver, {} replaced by newer ones before vision read them; "
      "reopened {} times",
      frames.captured, frames.dropped_by_driver, frames.dropped_unread, frames.reopened);
  const RobotState robot = telemetry_.snapshot().tick.input.robot;
  spdlog::info(
      "robot: {} packets, {} with a wrong checksum or length, {} bytes discarded; reconnected {} times",
      robot.sips, robot.checksum_errors, robot.bytes_discarded, robot.reconnects);
}

}  // namespace heel
