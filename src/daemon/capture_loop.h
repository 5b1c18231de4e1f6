// The loop of the capture thread: FrameSource → FrameTripleBuffer. Opens the source, opens it again after it
// is lost (with growing pauses), and counts. In steady state it does not allocate, lock or format, beyond
// what the library of a source does (file_source.h).
//
//   CaptureLoop loop(*source, frames, queues.captures, queues.capture_events);
//   std::jthread thread([&] { enter_thread(plan, realtime); loop.run(); });
//   …  loop.stop(); thread.join();
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "capture/frame_source.h"
#include "heel/flow.h"
#include "realtime/frame_triple_buffer.h"
#include "realtime/spsc_queue.h"

namespace heel {

struct CaptureLoopSettings {
  TimeNs wait_ns = 100 * kNsPerMs;          ///< longest wait for a frame; stop() takes effect within it
  TimeNs reopen_first_ns = 100 * kNsPerMs;  ///< pause before the first attempt to open again …
  TimeNs reopen_longest_ns = 2 * kNsPerS;   ///< … doubled at each failure up to this; a frame resets it
  bool restart_at_end = false;              ///< after the end of a stream, start it again
};

class CaptureLoop {
 public:
  /// Everything is borrowed and must outlive run(). Frames must have exactly the size of `frames`.
  CaptureLoop(FrameSource& source, FrameTripleBuffer& frames, SpscQueue<CaptureCounters>& counter_records,
              SpscQueue<Event>& events, const CaptureLoopSettings& settings = {});

  /// Runs until stop() or the end of the stream.
  void run();
  /// From any thread; also ends a pause.
  void stop();

  // From any thread:
  /// True: a file's last frame has been given and run() has returned, or is about to.
  bool ended() const { return ended_.load(std::memory_order_relaxed); }
  CaptureCounters counters() const;

 private:
  bool stopping() const { return stop_.load(std::memory_order_acquire) != 0; }
  void try_open();
  void pause();
  FrameResult wait_frame(FrameView& frame);
  void take_frame();
  void publish(const FrameView& frame);
  void restart_stream();
  void push_counters_if_changed();
  void push_event(EventKind kind, std::int64_t a, std::int64_t b, const char* text);

  FrameSource& source_;
  FrameTripleBuffer& frames_;
  SpscQueue<CaptureCounters>& counter_records_;
  SpscQueue<Event>& events_;
  CaptureLoopSettings settings_;

  bool open_ = false;
  bool delivered_ = false;            // a frame has come since the source was opened
  bool was_open_ = false;             // the next opening counts as reopening
  std::string reported_problem_;      // of an opening: each reason is reported once in an outage
  bool reported_wrong_size_ = false;  // since the source was opened
  TimeNs pause_ns_;
  CaptureCounters pushed_;

  std::atomic<std::uint32_t> stop_{0};  // also the futex of pauses
  std::atomic<bool> ended_{false};
  std::atomic<std::uint64_t> dropped_by_driver_{0};
  std::atomic<std::uint64_t> reopened_{0};
};

}  // namespace heel
