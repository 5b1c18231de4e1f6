// What telemetry does for the recording and the black box; telemetry.cpp has the records and the log.
#include <spdlog/spdlog.h>

#include <filesystem>
#include <mutex>
#include <system_error>
#include <utility>

#include "heel/error.h"
#include "realtime/clock.h"
#include "recording/recording_reader.h"
#include "telemetry/recording_folder.h"
#include "telemetry/telemetry.h"

namespace heel {
namespace {

constexpr std::size_t kMaxWaitingTexts = 256;
constexpr TimeNs kLimitsPeriod_ns = 10 * kNsPerS;

}  // namespace

/// First what the last run has left; then one for this run. heeld goes without where there is no place for
/// it.
void Telemetry::open_black_box() {
  if (config_.black_box.empty()) return;
  try {
    const std::string left = recording_ ? new_recording_path(config_.directory, "-black-box")
                                        : config_.black_box + kRecordingExtension;
    if (recover_black_box(config_.black_box, left))
      spdlog::warn("the last run of heeld did not end by itself: its last 30 s are in {}", left);
  } catch (const Error& error) {
    const std::string kept = config_.black_box + ".kept";
    std::error_code not_kept;
    std::filesystem::rename(config_.black_box, kept, not_kept);
    spdlog::warn("{}; the black box of the last run {}", error.what(),
                 not_kept ? "is lost: " + not_kept.message() : "is kept as " + kept);
  }
  try {
    black_box_ = std::make_unique<BlackBox>(config_.black_box, RecordingClock::wall());
  } catch (const Error& error) {
    spdlog::info("no black box: {}", error.what());
  }
}

/// With a recording everything is in there already.
void Telemetry::save_black_box() {
  if (!fault_) return;
  fault_ = false;
  if (!black_box_ || recorder_) return;
  const std::string path = config_.black_box + "-fault" + kRecordingExtension;
  try {
    black_box_->save(path);
    spdlog::info("the last 30 s before the fault are in {}", path);
  } catch (const Error& error) {
    spdlog::warn("black box: {}", error.what());
  }
}

void Telemetry::attach(const std::string& name, const std::string& media_type, std::string_view content) {
  if (recorder_) recorder_->attach(name, media_type, content);
}

void Telemetry::listen(TelemetryListener& listener) {
  listener_ = &listener;
  pictures_.show_to([&listener](const FrameView& frame) { listener.picture(frame); });
}

void Telemetry::end_recording(const std::string& why) {
  if (!recorder_) return;
  recorder_->record(RecordingNote{monotonic_now_ns(), "end", why, newest_.records_lost});
  recording_.store(false, std::memory_order_relaxed);
  recorder_.reset();
}

/// Those of the queue; and those before a fault. Where nothing is recorded any more none is wanted: a full
/// queue would count as a loss.
void Telemetry::take_pictures(TimeNs budget_ns) {
  const bool shown = listener_ != nullptr && listener_->wants_pictures();
  pictures_.set_wanted(shown || (recorder_ && pictures_.records()));
  if (!recorder_) {
    pictures_.discard();
    return;
  }
  pictures_.drain(*recorder_, budget_ns);
  if (pictures_wanted_) pictures_.write_kept(*recorder_);
  pictures_wanted_ = false;
}

void Telemetry::keep_within_limits(TimeNs now_ns) {
  if (!recorder_ || now_ns - t_limits_checked_ns_ < kLimitsPeriod_ns) return;
  t_limits_checked_ns_ = now_ns;
  const KeepLimits limits{static_cast<std::uint64_t>(config_.keep_mb * 1e6),
                          ns_from_seconds(config_.keep_days * 86400.0)};
  const std::uint64_t left = remove_old_recordings(config_.directory, recorder_->path(), limits);
  if (left <= limits.bytes) return;
  spdlog::warn("recording {} ends here: it needs more than telemetry.keep_mb", recorder_->path());
  end_recording("more than telemetry.keep_mb");
}

template <typename Text>
void Telemetry::add_text(std::vector<Text>& waiting, Text text) {
  const std::lock_guard lock(texts_mutex_);
  if (waiting.size() < kMaxWaitingTexts) {
    waiting.push_back(std::move(text));
  } else {
    ++texts_.dropped;
  }
}

void Telemetry::configuration(ConfigurationText configuration) {
  add_text(texts_.configurations, std::move(configuration));
}

void Telemetry::operator_line(OperatorLine line) {
  add_text(texts_.operator_lines, std::move(line));
}

bool Telemetry::mark(const std::string& text) {
  if (!recording_.load(std::memory_order_relaxed)) return false;
  add_text(texts_.marks, RecordingNote{monotonic_now_ns(), "mark", text, 0});
  return true;
}

void Telemetry::take_texts() {
  Texts texts;
  {
    const std::lock_guard lock(texts_mutex_);
    texts.configurations.swap(texts_.configurations);
    texts.operator_lines.swap(texts_.operator_lines);
    texts.marks.swap(texts_.marks);
    texts_lost_ = texts_.dropped;
  }
  if (black_box_ && !texts.configurations.empty()) black_box_->add(texts.configurations.back());
  if (!recorder_) return;
  for (const ConfigurationText& configuration : texts.configurations) recorder_->record(configuration);
  for (const OperatorLine& line : texts.operator_lines) recorder_->record(line);
  for (const RecordingNote& mark : texts.marks) recorder_->record(mark);
  pictures_wanted_ = pictures_wanted_ || !texts.marks.empty();
}

}  // namespace heel
