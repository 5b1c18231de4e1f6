// The telemetry thread: takes what the hot threads have pushed, logs events, records everything, and keeps
// the newest of each kind for whoever asks (status, live view). Neither hot nor real-time: it may lock and
// format.
//
//   TelemetryQueues queues;
//   Telemetry telemetry(queues, config.telemetry);            // throws heel::Error, before the threads start
//   std::jthread thread([&] { enter_thread(plan, false); telemetry.run(); });
//   …  telemetry.stop(); thread.join();                      // writes out the rest
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "core/config.h"
#include "heel/flow.h"
#include "telemetry/recorder.h"
#include "telemetry/telemetry_queues.h"

namespace heel {

/// The newest of everything.
struct TelemetrySnapshot {
  std::uint64_t ticks = 0;  ///< taken so far; 0: `tick` says nothing yet
  std::uint64_t poses = 0;
  std::uint64_t events = 0;
  std::uint64_t records_lost = 0;  ///< dropped by full queues
  TickRecord tick;
  PoseEstimate pose;
  CaptureCounters capture;
};

class Telemetry {
 public:
  /// Records when config.directory is not empty. Throws heel::Error when it cannot.
  Telemetry(TelemetryQueues& queues, const TelemetryConfig& config);

  /// The thread's body: a round every 50 ms until stop(), then a last one.
  void run();
  /// From any thread.
  void stop();
  /// One round: takes everything that waits. run() does this; a program without threads may, too.
  void drain(TimeNs now_ns);

  /// From any thread.
  TelemetrySnapshot snapshot() const;

 private:
  void take(const TickRecord& tick);
  void take(const Event& event);
  void log_losses(TimeNs now_ns);

  TelemetryQueues& queues_;
  std::unique_ptr<Recorder> recorder_;  // null: nothing is recorded

  TelemetrySnapshot newest_;
  mutable std::mutex published_mutex_;
  TelemetrySnapshot published_;

  std::array<TimeNs, 16> logged_ns_{};  // by EventKind: when a repeating one was logged last
  std::uint64_t lost_told_ = 0;
  TimeNs losses_told_ns_ = 0;
  TimeNs flushed_ns_ = 0;
  std::atomic<std::uint32_t> stop_{0};  // also the futex of the pause between rounds
};

}  // namespace heel
