#include "telemetry/telemetry.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "core/state_sentence.h"
#include "logging/journal_sink.h"
#include "realtime/clock.h"
#include "realtime/futex.h"
#include "telemetry/event_text.h"

namespace heel {

namespace {

constexpr TimeNs kDrainPeriod_ns = 50 * kNsPerMs;
constexpr TimeNs kFlushPeriod_ns = 500 * kNsPerMs;
constexpr TimeNs kLastPictures_ns = 500 * kNsPerMs;  // at the end, for those that wait
constexpr TimeNs kRepeatedEventPeriod_ns = kNsPerS;

static_assert(static_cast<std::size_t>(EventKind::Warning) < 16, "Telemetry::t_logged_ns_ is too short");

/// Which gate refused the tick's pose; empty: none did.
std::string refusal_of(const TickRecord& tick) {
  switch (tick.measurement) {
    case MeasurementStatus::None:
    case MeasurementStatus::Accepted:
      return "";
    case MeasurementStatus::NotFound:
      return fmt::format("shirt not found: {}", to_string(tick.input.pose.reason));
    default:
      return fmt::format("pose not used: {}", to_string(tick.measurement));
  }
}

}  // namespace

Telemetry::Telemetry(TelemetryQueues& queues, const TelemetryConfig& config, PictureQueue* pictures,
                     PictureRecorder::Encoder encoder)
    : queues_(queues),
      recording_(!config.directory.empty()),
      config_(config),
      pictures_(pictures, config.pictures, std::move(encoder)) {
  open_black_box();
  if (!recording_) return;
  recorder_ = std::make_unique<Recorder>(new_recording_path(config.directory), RecordingClock::wall());
  recorder_->record(RecordingNote{monotonic_now_ns(), "begin", "heeld", 0});
  keep_within_limits(monotonic_now_ns());
}

void Telemetry::run() {
  PeriodicDeadline deadline(kDrainPeriod_ns, monotonic_now_ns());
  while (stop_.load(std::memory_order_acquire) == 0) {
    TimeNs now_ns = monotonic_now_ns();
    if (now_ns < deadline.next_ns()) {
      futex_wait(stop_, 0, deadline.next_ns() - now_ns, FutexScope::Process);
      continue;
    }
    deadline.advance(now_ns);
    drain(now_ns);
  }
  drain(monotonic_now_ns());
  take_pictures(kLastPictures_ns);
  if (recorder_ && pictures_.records()) newest_.records_lost += pictures_.discard();
  end_recording("heeld stopped");
  if (black_box_) black_box_->end();
}

void Telemetry::stop() {
  stop_.store(1, std::memory_order_release);
  futex_wake_all(stop_, FutexScope::Process);
}

void Telemetry::drain(TimeNs now_ns) {
  take_texts();
  for (TickRecord tick; queues_.ticks.pop(tick);) take(tick);
  for (PoseEstimate pose; queues_.poses.pop(pose);) {
    ++newest_.poses;
    newest_.pose = pose;
    // Marks go out before their pose, so those of this one are here.
    for (PoseMarks marks; queues_.marks.pop(marks);)
      if (listener_ != nullptr) listener_->marks(marks);
    if (listener_ != nullptr) listener_->pose(pose);
    if (recorder_) recorder_->record(pose);
    if (black_box_) black_box_->add(pose);
  }
  for (FrameTiming timing; queues_.timings.pop(timing);) {
    if (recorder_) recorder_->record(timing);
  }
  for (CaptureCounters capture; queues_.captures.pop(capture);) {
    newest_.capture = capture;
    if (recorder_) recorder_->record(capture);
  }
  for (SpscQueue<Event>* events : {&queues_.capture_events, &queues_.control_events}) {
    for (Event event; events->pop(event);) take(event);
  }
  for (WireBytes bytes; queues_.wire.pop(bytes);) {
    if (recorder_) recorder_->record(bytes);
    if (black_box_) black_box_->add(bytes);
  }
  take_pictures(PictureRecorder::kDrain_ns);
  save_black_box();
  log_losses(now_ns);
  keep_within_limits(now_ns);
  if (recorder_ && now_ns - t_flushed_ns_ >= kFlushPeriod_ns) {
    recorder_->sync();
    t_flushed_ns_ = now_ns;
  }
  const std::lock_guard lock(published_mutex_);
  published_ = newest_;
}

// Of the ticks only changes are logged.
void Telemetry::take(const TickRecord& tick) {
  const bool first = newest_.ticks == 0;
  take_state(tick, first);
  if (first || tick.input.robot.phase != newest_.tick.input.robot.phase) {
    const std::string text = fmt::format("link to the robot: {}", to_string(tick.input.robot.phase));
    const bool lost = tick.input.robot.phase == LinkPhase::Lost;
    log_event({.part = "robot", .event = to_string(tick.input.robot.phase)},
              lost ? spdlog::level::warn : spdlog::level::info, text);
    if (recorder_) recorder_->record_text(tick.input.now_ns, text);
  }
  take_brakes(tick);
  take_measurement(tick);
  take_picture(tick);
  ++newest_.ticks;
  newest_.tick = tick;
  if (listener_ != nullptr) listener_->tick(tick);
  if (recorder_) recorder_->record(tick);
  if (black_box_) black_box_->add(tick);
}

/// Changes of state or reason, and of what the gate holds the robot by: of these at most one a second,
/// because the noise of an echo at the limit changes them with each packet.
void Telemetry::take_state(const TickRecord& tick, bool first) {
  const TimeNs now_ns = tick.input.now_ns;
  const bool moved = !first && tick.state != newest_.tick.state;
  if (moved && (tick.state == SupervisorState::Stopped || tick.state == SupervisorState::Emergency))
    pictures_wanted_ = fault_ = true;
  const bool stopped = first || moved || tick.stop_reason != newest_.tick.stop_reason;
  const bool held = tick.hold != logged_hold_ && now_ns - t_hold_logged_ns_ >= kRepeatedEventPeriod_ns;
  if (!stopped && !held) return;
  logged_hold_ = tick.hold;
  t_hold_logged_ns_ = now_ns;
  const std::string cause =
      moved ? fmt::format(" ({}: {})", to_string(tick.state), to_string(tick.cause)) : "";
  const std::string text = state_sentence(tick) + cause;
  const char* const event = tick.hold != Hold::None ? to_string(tick.hold) : to_string(tick.stop_reason);
  log_event({.part = "supervisor", .event = event}, spdlog::level::info, text);
  if (recorder_) recorder_->record_text(now_ns, text);
}

/// The robot slowed down with less than its controller allows.
void Telemetry::take_brakes(const TickRecord& tick) {
  constexpr double kNews = 0.9;  // of what was logged
  const double brakes_m_s2 = tick.planned_deceleration_m_s2;
  if (!tick.brakes_are_weaker) logged_brakes_m_s2_ = std::numeric_limits<double>::infinity();
  if (!tick.brakes_are_weaker || brakes_m_s2 >= kNews * logged_brakes_m_s2_) return;
  logged_brakes_m_s2_ = brakes_m_s2;
  const std::string text = fmt::format(
      "the robot slowed down with {:.2f} m/s² where {:.2f} were planned: speeds near people and obstacles "
      "are lower now; check its brakes and the slope",
      brakes_m_s2, tick.input.robot.limits.deceleration_m_s2);
  log_event({.part = "robot", .event = "brakes"}, spdlog::level::warn, text);
  if (recorder_) recorder_->record_text(tick.input.now_ns, text);
}

void Telemetry::take_measurement(const TickRecord& tick) {
  const PoseEstimate& pose = tick.input.pose;
  if (tick.measurement == MeasurementStatus::Accepted && pose.template_index != template_in_use_) {
    template_in_use_ = pose.template_index;
    const std::string text = fmt::format("template {} is in use", template_in_use_);
    log_event({.part = "vision", .event = "template"}, spdlog::level::info, text);
    if (recorder_) recorder_->record_text(tick.input.now_ns, text);
  }
  const TimeNs now_ns = tick.input.now_ns;
  const bool too_soon = !logged_refusal_.empty() && now_ns - t_refusal_logged_ns_ < kRepeatedEventPeriod_ns;
  if (too_soon) return;
  if (tick.measurement == MeasurementStatus::Accepted) logged_refusal_.clear();
  const std::string refusal = refusal_of(tick);
  if (refusal.empty() || refusal == logged_refusal_) return;
  logged_refusal_ = refusal;
  t_refusal_logged_ns_ = now_ns;
  log_event({.part = "vision", .event = to_string(tick.measurement)}, spdlog::level::info, refusal);
  if (recorder_) recorder_->record_text(now_ns, refusal);
}

/// Changes of what the pictures show wrong.
void Telemetry::take_picture(const TickRecord& tick) {
  const PictureFault fault = tick.input.pose.picture;
  if (fault == picture_fault_) return;
  picture_fault_ = fault;
  const bool good = fault == PictureFault::None;
  const std::string text = good ? "the pictures are good again" : picture_sentence(fault);
  log_event({.part = "camera", .event = to_string(fault)}, good ? spdlog::level::info : spdlog::level::warn,
            text);
  if (recorder_) recorder_->record_text(tick.input.now_ns, text);
}

void Telemetry::take(const Event& event) {
  ++newest_.events;
  if (listener_ != nullptr) listener_->event(event);
  if (recorder_) recorder_->record(event);
  if (black_box_) black_box_->add(event);
  TimeNs& t_logged_ns = t_logged_ns_[static_cast<std::size_t>(event.kind)];
  const bool too_soon = t_logged_ns != 0 && event.t_ns - t_logged_ns < kRepeatedEventPeriod_ns;
  if (event_repeats(event.kind) && too_soon) return;
  t_logged_ns = event.t_ns;
  log_event({.part = event_part(event.kind), .event = to_string(event.kind)}, event_level(event.kind),
            event_text(event));
  if (recorder_) recorder_->record_text(event.t_ns, event_text(event));
}

void Telemetry::log_losses(TimeNs now_ns) {
  if (recorder_) recorder_lost_ = recorder_->records_lost();
  newest_.records_lost = queues_.ticks.dropped() + queues_.poses.dropped() + queues_.captures.dropped() +
                         queues_.timings.dropped() + queues_.capture_events.dropped() +
                         queues_.control_events.dropped() + queues_.wire.dropped() + texts_lost_ +
                         pictures_.lost() + recorder_lost_;
  if (newest_.records_lost == losses_logged_ || now_ns - t_losses_logged_ns_ < kRepeatedEventPeriod_ns)
    return;
  spdlog::warn("telemetry is too slow: {} records lost so far", newest_.records_lost);
  if (recorder_) recorder_->record(RecordingNote{now_ns, "lost", "records lost", newest_.records_lost});
  losses_logged_ = newest_.records_lost;
  t_losses_logged_ns_ = now_ns;
}

TelemetrySnapshot Telemetry::snapshot() const {
  const std::lock_guard lock(published_mutex_);
  return published_;
}

}  // namespace heel
