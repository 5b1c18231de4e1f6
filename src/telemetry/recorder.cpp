#include "telemetry/recorder.h"

#include <fmt/chrono.h>

#include <array>
#include <ctime>
#include <filesystem>
#include <system_error>

#include "heel/error.h"
#include "realtime/clock.h"
#include "telemetry/csv_columns.h"
#include "telemetry/event_text.h"

namespace heel {

namespace fs = std::filesystem;

namespace {

struct RecordingName {
  const char* stem;
  const char* extension;
  fs::path path(const fs::path& folder) const { return folder / fmt::format("{}{}", stem, extension); }
  fs::path numbered(const fs::path& folder, int n) const {
    return folder / fmt::format("{}.{}{}", stem, n, extension);
  }
};

constexpr std::array<RecordingName, 4> kNames{
    {{"ticks", ".csv"}, {"poses", ".csv"}, {"capture", ".csv"}, {"events", ".log"}}};

bool any_exists(const fs::path& folder, int n) {
  for (const RecordingName& name : kNames) {
    if (fs::exists(n == 0 ? name.path(folder) : name.numbered(folder, n))) return true;
  }
  return false;
}

/// An earlier recording is never overwritten: all of its files get the same number.
void rename_earlier_recording(const fs::path& folder) {
  if (!any_exists(folder, 0)) return;
  int number = 1;
  while (any_exists(folder, number)) ++number;
  for (const RecordingName& name : kNames) {
    if (fs::exists(name.path(folder))) fs::rename(name.path(folder), name.numbered(folder, number));
  }
}

}  // namespace

Recorder::Recorder(const std::string& directory) {
  try {
    fs::create_directories(directory);
    rename_earlier_recording(directory);
  } catch (const fs::filesystem_error& error) {
    throw Error("telemetry.directory " + directory + ": " + error.code().message() +
                " (expected a folder that can be written)");
  }
  ticks_ = std::make_unique<RecordFile>(kNames[0].path(directory));
  poses_ = std::make_unique<RecordFile>(kNames[1].path(directory));
  capture_ = std::make_unique<RecordFile>(kNames[2].path(directory));
  events_ = std::make_unique<RecordFile>(kNames[3].path(directory));
  ticks_->append(csv_header(tick_columns()));
  poses_->append(csv_header(pose_columns()));
  capture_->append(csv_header(capture_columns()));
  record_text(monotonic_now_ns(),
              fmt::format("recording begins at {:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))));
}

void Recorder::record(const TickRecord& tick) {
  ticks_->append(csv_row(line_, tick_columns(), tick));
}

void Recorder::record(const PoseEstimate& pose) {
  poses_->append(csv_row(line_, pose_columns(), pose));
}

void Recorder::record(const CaptureCounters& capture) {
  capture_->append(csv_row(line_, capture_columns(), capture));
}

void Recorder::record(const Event& event) {
  record_text(event.t_ns, event_text(event));
}

void Recorder::record_text(TimeNs t_ns, std::string_view text) {
  line_.clear();
  line_.seconds(t_ns);
  std::string whole(line_.finish());
  whole.back() = ' ';
  whole.append(text).push_back('\n');
  events_->append(whole);
}

void Recorder::flush() {
  ticks_->flush();
  poses_->flush();
  capture_->flush();
  events_->flush();
}

}  // namespace heel
