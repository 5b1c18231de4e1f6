#include "daemon/capture_loop.h"

#include <algorithm>
#include <cstring>

#include "realtime/clock.h"
#include "realtime/futex.h"

namespace heel {

CaptureLoop::CaptureLoop(FrameSource& source, FrameTripleBuffer& ring, SpscQueue<CaptureCounters>& counts,
                         SpscQueue<Event>& events, const CaptureLoopSettings& settings)
    : source_(source),
      ring_(ring),
      counts_(counts),
      events_(events),
      settings_(settings),
      pause_ns_(settings.reopen_first_ns) {}

void CaptureLoop::run() {
  if (open_) tell(EventKind::CameraOpened, 0, 0, source_.description().c_str());
  was_open_ = open_;
  while (!stopping() && !ended_.load(std::memory_order_relaxed)) {
    heartbeat_ns_.store(monotonic_now_ns(), std::memory_order_relaxed);
    if (open_) {
      take_frame();
    } else {
      try_open();
    }
    push_counts();
  }
  source_.close();
  open_ = false;
}

void CaptureLoop::stop() {
  stop_.store(1, std::memory_order_release);
  futex_wake_all(stop_, FutexScope::Process);
}

void CaptureLoop::try_open() {
  open_ = source_.open() == OpenResult::Opened;
  delivered_ = false;
  if (open_) {
    if (was_open_) reopened_.fetch_add(1, std::memory_order_relaxed);
    was_open_ = true;
    told_problem_.clear();
    told_refused_ = false;
    tell(EventKind::CameraOpened, 0, 0, source_.description().c_str());
    return;
  }
  if (source_.problem() != told_problem_) {
    told_problem_ = source_.problem();
    tell(EventKind::CameraUnavailable, 0, 0, told_problem_.c_str());
  }
  pause();
}

void CaptureLoop::pause() {
  // The pause is slept in pieces, so that the heart goes on beating.
  const TimeNs until_ns = monotonic_now_ns() + pause_ns_;
  for (TimeNs now_ns = monotonic_now_ns(); now_ns < until_ns && !stopping(); now_ns = monotonic_now_ns()) {
    heartbeat_ns_.store(now_ns, std::memory_order_relaxed);
    futex_wait(stop_, 0, std::min(until_ns - now_ns, settings_.wait_ns), FutexScope::Process);
  }
  pause_ns_ = std::min(2 * pause_ns_, settings_.reopen_longest_ns);
}

void CaptureLoop::take_frame() {
  FrameView frame;
  const FrameResult result = source_.wait_frame(settings_.wait_ns, frame);
  dropped_by_driver_.store(source_.counters().dropped_by_driver + source_.counters().corrupt,
                           std::memory_order_relaxed);
  switch (result) {
    case FrameResult::Frame: {
      // Only a frame shows that it works: the next outage begins with a short pause.
      delivered_ = true;
      pause_ns_ = settings_.reopen_first_ns;
      const FrameHeader& header = frame.header;
      const bool right_size = !settings_.exact_size || (header.width_px == ring_.max_width_px() &&
                                                        header.height_px == ring_.max_height_px());
      if (right_size && ring_.push(frame)) return;
      if (!told_refused_) tell(EventKind::FrameRefused, header.width_px, header.height_px, "");
      told_refused_ = true;
      return;
    }
    case FrameResult::Timeout:
      return;
    case FrameResult::Error: {
      const auto unusable = static_cast<std::int64_t>(dropped_by_driver_.load(std::memory_order_relaxed));
      tell(EventKind::FrameCorrupt, unusable, 0, source_.problem().c_str());
      return;
    }
    case FrameResult::EndOfStream:
      if (settings_.begin_again) {
        source_.close();
        if (!delivered_) pause();
        open_ = source_.open() == OpenResult::Opened;
        delivered_ = false;
        return;
      }
      tell(EventKind::CameraEnded, 0, 0, source_.problem().c_str());
      ended_.store(true, std::memory_order_relaxed);
      return;
    case FrameResult::Lost:
      tell(EventKind::CameraLost, 0, 0, source_.problem().c_str());
      source_.close();
      open_ = false;
      if (!delivered_) pause();
      return;
  }
}

CaptureCounters CaptureLoop::counters() const {
  return {.captured = ring_.captured(),
          .dropped_by_driver = dropped_by_driver_.load(std::memory_order_relaxed),
          .dropped_unread = ring_.dropped(),
          .reopened = reopened_.load(std::memory_order_relaxed)};
}

void CaptureLoop::push_counts() {
  CaptureCounters now = counters();
  now.t_ns = pushed_.t_ns;
  if (now == pushed_) return;
  now.t_ns = monotonic_now_ns();
  pushed_ = now;
  counts_.push(now);
}

void CaptureLoop::tell(EventKind kind, std::int64_t a, std::int64_t b, const char* text) {
  Event event{.t_ns = monotonic_now_ns(), .kind = kind, .a = a, .b = b};
  std::strncpy(event.text.data(), text, event.text.size() - 1);
  events_.push(event);
}

}  // namespace heel
