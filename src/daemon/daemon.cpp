#include "daemon/daemon.h"

#include <spdlog/spdlog.h>

#include <atomic>
#include <cstring>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "capture/factory/frame_source_factory.h"
#include "capture/frame_source.h"
#include "config/config_load.h"
#include "config/config_text.h"
#include "daemon/capture_loop.h"
#include "daemon/control_loop.h"
#include "daemon/control_port.h"
#include "daemon/inputs.h"
#include "daemon/loop_thread.h"
#include "daemon/signals.h"
#include "daemon/status_reporter.h"
#include "daemon/vision_loop.h"
#include "files/atomic_file.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "logging/logging.h"
#include "logging/recent_log.h"
#include "operator/local_socket.h"
#include "operator/mqtt/mqtt_publisher.h"
#include "operator/operator_server.h"
#include "operator/settings.h"
#include "operator/settings_loop.h"
#include "operator/web/live_feed.h"
#include "operator/web/view_server.h"
#include "realtime/clock.h"
#include "realtime/schedule.h"
#include "telemetry/telemetry.h"
#include "vision/pose/template_selector.h"

namespace heel {
namespace {

constexpr TimeNs kMainPeriod_ns = 100 * kNsPerMs;
constexpr TimeNs kRestTimeout_ns = 3 * kNsPerS;  // for coming to rest after the end of a file camera
constexpr TimeNs kReconfigureTimeout_ns = kNsPerS;

std::optional<LocalSocket> make_socket(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return std::optional<LocalSocket>(std::in_place, path);
}

std::unique_ptr<PictureQueue> make_picture_queue(const Config& config, const CameraModel& camera) {
  constexpr std::size_t kRecordedFrames = 48;  // more than a second, for a disk that is slow to sync
  constexpr std::size_t kShownFrames = 4;      // more than telemetry's period
  const bool recorded = !config.telemetry.directory.empty() && config.telemetry.pictures != "none";
  if (!recorded && config.view.address.empty()) return nullptr;
  return std::make_unique<PictureQueue>(recorded ? kRecordedFrames : kShownFrames,
                                        static_cast<std::uint32_t>(camera.width_px),
                                        static_cast<std::uint32_t>(camera.height_px));
}

class Daemon {
 public:
  /// `log`: the newest lines of the log, for the page.
  Daemon(LoadedConfig loaded, Signals& signals, std::shared_ptr<RecentLog> log);
  int run();

 private:
  void start();
  std::thread start_thread(ThreadRole role, std::function<void()> loop);
  void serve_until_stopped();
  void start_reload();
  void end_reload();
  void apply(const Config& config);
  void attach_vision_files();
  bool finished_and_stopped(TimeNs now_ns);
  void stop();
  void log_counters() const;

  const LoadedConfig loaded_;  // at the start
  Inputs inputs_;
  Signals& signals_;
  StatusReporter status_;
  // Made before anything is opened that a heeld that serves the socket already uses: robot and camera.
  std::optional<LocalSocket> socket_;  // until operators_ has it; empty: none

  TelemetryQueues queues_;
  FrameTripleBuffer frames_;
  std::unique_ptr<PictureQueue> pictures_;  // to the recording; null: none
  Mailbox<PoseEstimate> poses_;
  std::unique_ptr<FrameSource> source_;
  TemplateSelector templates_;
  CaptureLoop capture_;
  VisionLoop vision_;
  ControlLoop control_;
  Telemetry telemetry_;
  Settings settings_;
  SettingsLoop settings_loop_;
  ControlPort control_port_;
  std::unique_ptr<OperatorServer> operators_;  // null: no socket
  const std::shared_ptr<RecentLog> log_;
  const ViewFacts view_facts_;
  LiveFeed live_feed_;
  std::unique_ptr<ViewServer> view_;     // null: no page
  std::unique_ptr<MqttPublisher> mqtt_;  // null: no broker
  std::thread capture_thread_, vision_thread_, control_thread_, telemetry_thread_, settings_thread_,
      operator_thread_, view_thread_, mqtt_thread_;

  std::uint64_t configurations_ = 0;  // taken over since the start; for the settings thread
  std::uint64_t reloads_started_ = 0, reloads_ended_ = 0;
  TimeNs t_ended_ns_ = 0;            // when a file camera gave its last frame; 0: not yet
  std::atomic<bool> failed_{false};  // a thread has ended by an exception
};

}  // namespace

// Load.
int run_daemon(const std::string& config_path) {
  prepare_process_memory();
  LoadedConfig loaded = load_config(config_path);
  // Before anything that starts a thread (logging and OpenCV do): a thread that does not block SIGTERM would
  // receive it, and the process would end with the wheels turning.
  Signals signals;
  const auto log = std::make_shared<RecentLog>();
  start_logging(loaded.config.runtime.log_level, log);
  int exit_status = 1;
  try {
    exit_status = Daemon(std::move(loaded), signals, log).run();
  } catch (...) {
    stop_logging();
    throw;
  }
  stop_logging();
  return exit_status;
}

// Wire.
Daemon::Daemon(LoadedConfig loaded, Signals& signals, std::shared_ptr<RecentLog> log)
    : loaded_(std::move(loaded)),
      inputs_(load_inputs(loaded_.config)),
      signals_(signals),
      status_(loaded_.config.runtime),
      socket_(make_socket(loaded_.config.operators.socket)),
      frames_(static_cast<std::uint32_t>(inputs_.camera.width_px),
              static_cast<std::uint32_t>(inputs_.camera.height_px)),
      pictures_(make_picture_queue(loaded_.config, inputs_.camera)),
      source_(make_frame_source(loaded_.config.camera)),
      templates_(inputs_.shirts, inputs_.camera, loaded_.config.vision),
      capture_(*source_, frames_, queues_.captures, queues_.capture_events,
               {.restart_at_end = loaded_.config.camera.at_end == "loop"}),
      vision_(frames_, templates_, poses_, queues_, pictures_.get()),
      control_(loaded_.config, poses_, queues_),
      telemetry_(queues_, loaded_.config.telemetry, pictures_.get()),
      settings_(loaded_, {[this](const Config& config) { check_against_camera(config, inputs_.camera); },
                          [this](const Config& config) { apply(config); }}),
      settings_loop_(settings_),
      control_port_(control_, capture_, telemetry_),
      log_(std::move(log)),
      view_facts_(view_facts(inputs_)),
      live_feed_(loaded_.config.view.picture_hz) {
  telemetry_.configuration({monotonic_now_ns(), configurations_, config_toml(loaded_.config)});
  if (pictures_) attach_vision_files();
  if (socket_)
    operators_ =
        std::make_unique<OperatorServer>(std::move(*socket_), control_port_, settings_, settings_loop_);
  if (!loaded_.config.mqtt.address.empty())
    mqtt_ =
        std::make_unique<MqttPublisher>(loaded_.config.mqtt, MqttParts{settings_, telemetry_, control_port_});
  if (loaded_.config.view.address.empty()) return;
  const ViewParts parts{settings_,  telemetry_, control_port_, operators_.get(),
                        live_feed_, *log_,      view_facts_};
  view_ = std::make_unique<ViewServer>(loaded_.config.view, parts);
  telemetry_.listen(live_feed_);
}

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
  // Telemetry first, to record what the others report; operators before control, so that an emergency stop is
  // served whenever the wheels can turn; control before capture, to connect to the robot early.
  telemetry_thread_ = start_thread(ThreadRole::Telemetry, [this] { telemetry_.run(); });
  settings_thread_ = start_thread(ThreadRole::Settings, [this] { settings_loop_.run(); });
  if (operators_) operator_thread_ = start_thread(ThreadRole::Operator, [this] { operators_->run(); });
  if (view_) view_thread_ = start_thread(ThreadRole::View, [this] { view_->run(); });
  if (mqtt_) mqtt_thread_ = start_thread(ThreadRole::Mqtt, [this] { mqtt_->run(); });
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
    if (signal == Signal::Reload) start_reload();
    end_reload();
    status_.update(control_, frames_.captured() > 0, monotonic_now_ns());
    if (signal == Signal::Stop) {
      spdlog::info("stop signal received");
      return;
    }
  }
}

void Daemon::start_reload() {
  status_.reload_started(monotonic_now_ns());
  ++reloads_started_;
  if (settings_loop_.post({SettingsJobKind::Reload})) return;
  spdlog::error("reload refused: too many changes of settings wait already");
  --reloads_started_;
  status_.reload_ended();
}

/// The settings thread reloads, which may wait for the disk: this thread feeds the watchdog.
void Daemon::end_reload() {
  const std::uint64_t ended = settings_loop_.reloads();
  if (ended == reloads_ended_) return;
  reloads_ended_ = ended;
  if (reloads_ended_ == reloads_started_) status_.reload_ended();
}

/// What a replay of vision needs beside the pictures.
void Daemon::attach_vision_files() {
  constexpr std::size_t kMaxBytes = 1 << 26;
  const Config& config = loaded_.config;
  telemetry_.attach("camera.yaml", "text/yaml", read_whole_file(config.camera.info, kMaxBytes));
  for (std::size_t i = 0; i <= config.target.more_shirts.size(); ++i)
    telemetry_.attach(fmt::format("shirt-{}.heel", i), "application/octet-stream",
                      read_whole_file(template_file(config.target, i), kMaxBytes));
}

/// In the settings thread.
void Daemon::apply(const Config& config) {
  if (!control_.reconfigure(config, kReconfigureTimeout_ns)) {
    throw Error(fmt::format("the control loop did not take the new configuration within {:.1f} s",
                            seconds_from_ns(kReconfigureTimeout_ns)));
  }
  set_log_level(config.runtime.log_level);
  telemetry_.configuration({monotonic_now_ns(), ++configurations_, config_toml(config)});
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
  if (mqtt_) mqtt_->stop();
  if (view_) {
    view_->stop();
    view_thread_.join();
  }
  settings_loop_.stop();
  settings_thread_.join();
  if (operators_) {
    operators_->stop();
    operator_thread_.join();
    operators_.reset();
  }
  capture_.stop();
  vision_.stop();
  capture_thread_.join();
  vision_thread_.join();
  telemetry_.stop();
  telemetry_thread_.join();
  view_.reset();
  status_.send_kept();
  log_counters();
  // Last, because it may wait for a broker, and longer for the look-up of its name.
  if (mqtt_) mqtt_thread_.join();
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
