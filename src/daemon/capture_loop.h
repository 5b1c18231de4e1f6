// The capture thread's body: source → ring. Opens the source, opens it again when it is lost (with growing
// pauses), counts, beats its heart. In steady state it does not allocate, lock or format (beyond what a
// source's own library does; see file_source.h).
//
//   CaptureLoop loop(*source, ring, feeds.captures, feeds.capture_events);
//   std::jthread thread([&] { enter_thread(plan, realtime); loop.run(); });
//   …  loop.stop(); thread.join();
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "capture/factory/frame_source_factory.h"
#include "capture/frame_source.h"
#include "heel/flow.h"
#include "realtime/frame_triple_buffer.h"
#include "realtime/spsc_queue.h"

namespace heel {

struct CaptureLoopSettings {
  TimeNs wait_ns = 100 * kNsPerMs;          ///< longest wait for a frame: how soon stop() is seen
  TimeNs reopen_first_ns = 100 * kNsPerMs;  ///< pause before the first attempt to open again …
  TimeNs reopen_longest_ns = 2 * kNsPerS;   ///< … doubled at each failure up to this; a frame starts anew
  bool begin_again = false;                 ///< after a stream's end, from its beginning
  bool exact_size = true;                   ///< refuse frames that are not exactly the ring's size
};

class CaptureLoop {
 public:
  /// Everything is borrowed and must outlive run(). `source` may be open already.
  CaptureLoop(FrameSource& source, FrameTripleBuffer& ring, SpscQueue<CaptureCounters>& counts,
              SpscQueue<Event>& events, const CaptureLoopSettings& settings = {});

  /// Tells the loop that `source` is open already (as open_frame_source leaves it).
  void assume_open() { open_ = true; }

  /// Until stop(), or until the stream has ended.
  void run();
  /// From any thread; also ends pauses.
  void stop();

  // ── from any thread ──
  /// True: a file's last frame has been given and run() has returned.
  bool ended() const { return ended_.load(std::memory_order_relaxed); }
  /// When the loop last went round; it does so at least every `wait_ns`.
  TimeNs heartbeat_ns() const { return heartbeat_ns_.load(std::memory_order_relaxed); }
  CaptureCounters counters() const;

 private:
  bool stopping() const { return stop_.load(std::memory_order_acquire) != 0; }
  void try_open();
  void pause();
  void take_frame();
  void push_counts();
  void tell(EventKind kind, std::int64_t a, std::int64_t b, const char* text);

  FrameSource& source_;
  FrameTripleBuffer& ring_;
  SpscQueue<CaptureCounters>& counts_;
  SpscQueue<Event>& events_;
  CaptureLoopSettings settings_;

  bool open_ = false;
  bool delivered_ = false;     // a frame has come since the opening; without one it counts as failed
  bool was_open_ = false;      // an opening is a reopening from now on
  std::string told_problem_;   // of an opening: once for each reason in an outage
  bool told_refused_ = false;  // once for each opening
  TimeNs pause_ns_;
  CaptureCounters pushed_;

  std::atomic<std::uint32_t> stop_{0};  // also the futex of pauses
  std::atomic<bool> ended_{false};
  std::atomic<TimeNs> heartbeat_ns_{0};
  std::atomic<std::uint64_t> dropped_by_driver_{0};
  std::atomic<std::uint64_t> reopened_{0};
};

}  // namespace heel
