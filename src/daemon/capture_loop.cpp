#include "daemon/capture_loop.h"

#include <algorithm>
#include <cstring>

#include "realtime/clock.h"
#include "realtime/futex.h"
#include "realtime/hot_section.h"

namespace heel {

CaptureLoop::CaptureLoop(FrameSource& source, FrameTripleBuffer& frames,
                         SpscQueue<CaptureCounters>& counter_records, SpscQueue<Event>& events,
                         const CaptureLoopSettings& settings)
    : source_(source),
      frames_(frames),
      counter_records_(counter_records),
      events_(events),
      settings_(settings),
      pause_ns_(settings.reopen_first_ns) {}

void CaptureLoop::run() {
  while (!stopping() && !ended()) {
    if (open_) {
      take_frame();
    } else {
      try_open();
    }
    push_counters_if_changed();
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
    reported_problem_.clear();
    reported_wrong_size_ = false;
    push_event(EventKind::CameraOpened, 0, 0, source_.description().c_str());
    return;
  }
  if (source_.problem() != reported_problem_) {
    reported_problem_ = source_.problem();
    push_event(EventKind::CameraUnavailable, 0, 0, reported_problem_.c_str());
  }
  pause();
}

void CaptureLoop::pause() {
  const TimeNs until_ns = monotonic_now_ns() + pause_ns_;
  for (TimeNs now_ns = monotonic_now_ns(); now_ns < until_ns && !stopping(); now_ns = monotonic_now_ns()) {
    futex_wait(stop_, 0, until_ns - now_ns, FutexScope::Process);
  }
  pause_ns_ = std::min(2 * pause_ns_, settings_.reopen_longest_ns);
}

/// Opening and closing may allocate; a frame may not.
FrameResult CaptureLoop::wait_frame(FrameView& frame) {
  const HotSection hot;
  const FrameResult result = source_.wait_frame(settings_.wait_ns, frame);
  frame.header.t_dequeued_ns = monotonic_now_ns();
  return result;
}

void CaptureLoop::take_frame() {
  FrameView frame;
  const FrameResult result = wait_frame(frame);
  dropped_by_driver_.store(source_.counters().dropped_by_driver + source_.counters().corrupt,
                           std::memory_order_relaxed);
  switch (result) {
    case FrameResult::Frame:
      // Only a frame proves that the source works; an opening without one counts as failed.
      delivered_ = true;
      pause_ns_ = settings_.reopen_first_ns;
      return publish(frame);
    case FrameResult::Timeout:
      return;
    case FrameResult::Error: {
      const auto unusable = static_cast<std::int64_t>(dropped_by_driver_.load(std::memory_order_relaxed));
      return push_event(EventKind::FrameCorrupt, unusable, 0, source_.problem().c_str());
    }
    case FrameResult::EndOfStream:
      if (settings_.restart_at_end) return restart_stream();
      push_event(EventKind::CameraEnded, 0, 0, source_.problem().c_str());
      ended_.store(true, std::memory_order_relaxed);
      return;
    case FrameResult::Lost:
      push_event(EventKind::CameraLost, 0, 0, source_.problem().c_str());
      source_.close();
      open_ = false;
      if (!delivered_) pause();
      return;
  }
}

void CaptureLoop::publish(const FrameView& frame) {
  const HotSection hot;
  const FrameHeader& header = frame.header;
  const bool right_size =
      header.width_px == frames_.max_width_px() && header.height_px == frames_.max_height_px();
  if (right_size && frames_.push(frame)) return;
  if (!reported_wrong_size_) push_event(EventKind::FrameRefused, header.width_px, header.height_px, "");
  reported_wrong_size_ = true;
}

void CaptureLoop::restart_stream() {
  source_.close();
  if (!delivered_) pause();
  open_ = source_.open() == OpenResult::Opened;
  delivered_ = false;
}

CaptureCounters CaptureLoop::counters() const {
  return {.captured = frames_.captured(),
          .dropped_by_driver = dropped_by_driver_.load(std::memory_order_relaxed),
          .dropped_unread = frames_.dropped(),
          .reopened = reopened_.load(std::memory_order_relaxed)};
}

void CaptureLoop::push_counters_if_changed() {
  CaptureCounters now = counters();
  now.t_ns = pushed_.t_ns;
  if (now == pushed_) return;
  now.t_ns = monotonic_now_ns();
  pushed_ = now;
  counter_records_.push(now);
}

void CaptureLoop::push_event(EventKind kind, std::int64_t a, std::int64_t b, const char* text) {
  Event event{.t_ns = monotonic_now_ns(), .kind = kind, .a = a, .b = b};
  std::strncpy(event.text.data(), text, event.text.size() - 1);
  events_.push(event);
}

}  // namespace heel
