// The loop of the telemetry thread: takes the records that the real-time threads have pushed, logs events,
// writes the recording, and keeps the newest record of each kind. It is no real-time thread: it may lock,
// allocate and format.
//
//   TelemetryQueues queues;
//   Telemetry telemetry(queues, config.telemetry);            // throws heel::Error, before the threads start
//   std::jthread thread([&] { enter_thread(plan, false); telemetry.run(); });
//   …  telemetry.stop(); thread.join();                      // writes the rest
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "core/config.h"
#include "heel/flow.h"
#include "telemetry/black_box.h"
#include "telemetry/picture_recorder.h"
#include "telemetry/recorder.h"
#include "telemetry/telemetry_listener.h"
#include "telemetry/telemetry_queues.h"

namespace heel {

/// The newest record of each kind.
struct TelemetrySnapshot {
  std::uint64_t ticks = 0;  ///< taken so far; 0: `tick` has no value yet
  std::uint64_t poses = 0;
  std::uint64_t events = 0;
  std::uint64_t records_lost = 0;  ///< dropped by full queues
  TickRecord tick;
  PoseEstimate pose;
  CaptureCounters capture;
};

class Telemetry {
 public:
  /// Writes a recording when config.directory is not empty. Throws heel::Error when it cannot be created.
  /// `pictures`, where given, are the frames that vision has processed; it is borrowed.
  Telemetry(TelemetryQueues& queues, const TelemetryConfig& config, PictureQueue* pictures = nullptr,
            PictureRecorder::Encoder encoder = compressed_picture);

  /// Before run(): a file that belongs to the recording, as the template that the pictures were searched for.
  void attach(const std::string& name, const std::string& media_type, std::string_view content);

  /// Before run(): who else sees the records. It is borrowed.
  void listen(TelemetryListener& listener);

  /// Drains the queues every 50 ms until stop(), and then once more.
  void run();
  /// From any thread.
  void stop();
  /// Takes all waiting records once. run() calls this; a program without threads may call it itself.
  void drain(TimeNs now_ns);

  /// From any thread.
  TelemetrySnapshot snapshot() const;

  // From any thread but a real-time one (they lock and allocate); written with the next drain. When too many
  // wait, the new one is dropped and counted.
  void configuration(ConfigurationText configuration);
  void operator_line(OperatorLine line);
  /// A mark in the recording. False: nothing is recorded, or not any more.
  bool mark(const std::string& text);

 private:
  void take(const TickRecord& tick);
  void take_state(const TickRecord& tick, bool first);
  void take_brakes(const TickRecord& tick);
  void take_measurement(const TickRecord& tick);
  void take_picture(const TickRecord& tick);
  void take(const Event& event);
  void take_texts();
  void log_losses(TimeNs now_ns);
  void open_black_box();
  void save_black_box();
  void take_pictures(TimeNs budget_ns);
  void keep_within_limits(TimeNs now_ns);
  void end_recording(const std::string& why);

  template <typename Text>
  void add_text(std::vector<Text>& waiting, Text text);

  TelemetryQueues& queues_;
  std::atomic<bool> recording_;  // recorder_ is there; for other threads
  const TelemetryConfig config_;
  std::unique_ptr<Recorder> recorder_;   // null: nothing is recorded
  std::unique_ptr<BlackBox> black_box_;  // null: none
  PictureRecorder pictures_;
  TelemetryListener* listener_ = nullptr;  // null: none
  bool pictures_wanted_ = false;           // a fault or a mark has come since the last drain
  bool fault_ = false;                     // a fault has come since the last drain

  struct Texts {
    std::vector<ConfigurationText> configurations;
    std::vector<OperatorLine> operator_lines;
    std::vector<RecordingNote> marks;
    std::uint64_t dropped = 0;
  };
  std::mutex texts_mutex_;
  Texts texts_;  // guarded by texts_mutex_; those that wait

  TelemetrySnapshot newest_;
  mutable std::mutex published_mutex_;
  TelemetrySnapshot published_;

  std::array<TimeNs, 16> t_logged_ns_{};  // by EventKind: when it was logged last
  Hold logged_hold_ = Hold::None;
  TimeNs t_hold_logged_ns_ = 0;
  std::uint32_t template_in_use_ = 0;
  std::string logged_refusal_;  // the last one: a frame refused for another reason is logged again
  PictureFault picture_fault_ = PictureFault::None;  // logged last
  double logged_brakes_m_s2_ = std::numeric_limits<double>::infinity();
  TimeNs t_refusal_logged_ns_ = 0;
  std::uint64_t texts_lost_ = 0;
  std::uint64_t recorder_lost_ = 0;  // also after its end
  std::uint64_t losses_logged_ = 0;
  TimeNs t_losses_logged_ns_ = 0;
  TimeNs t_flushed_ns_ = 0;
  TimeNs t_limits_checked_ns_ = 0;
  std::atomic<std::uint32_t> stop_{0};  // also the futex of the pause between two drains
};

}  // namespace heel
