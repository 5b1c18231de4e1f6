#include "telemetry/recording_folder.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <vector>

#include "recording/recording_reader.h"

namespace heel {
namespace {

namespace fs = std::filesystem;

struct KeptRecording {
  fs::path path;
  std::uint64_t bytes = 0;
  TimeNs age_ns = 0;
};

/// The oldest first.
std::vector<KeptRecording> recordings_in(const std::string& folder) {
  std::vector<KeptRecording> all;
  std::error_code error;
  // A range-for would throw where the folder can be opened and not be read to its end.
  for (fs::directory_iterator at(folder, error); at != fs::directory_iterator(); at.increment(error)) {
    const fs::directory_entry& entry = *at;
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("heel-") || entry.path().extension() != kRecordingExtension) continue;
    std::error_code gone;  // removed by somebody else in this moment
    const auto age = fs::file_time_type::clock::now() - entry.last_write_time(gone);
    const std::uint64_t bytes = entry.file_size(gone);
    if (gone) continue;
    all.push_back({entry.path(), bytes, std::chrono::duration_cast<std::chrono::nanoseconds>(age).count()});
  }
  std::sort(all.begin(), all.end(), [](const KeptRecording& a, const KeptRecording& b) {
    return a.age_ns != b.age_ns ? a.age_ns > b.age_ns : a.path < b.path;
  });
  return all;
}

}  // namespace

std::uint64_t remove_old_recordings(const std::string& folder, const std::string& current,
                                    const KeepLimits& limits) {
  const std::vector<KeptRecording> all = recordings_in(folder);
  std::uint64_t bytes = 0;
  for (const KeptRecording& one : all) bytes += one.bytes;
  for (const KeptRecording& one : all) {
    const bool too_old = one.age_ns > limits.age_ns;
    if (!too_old && bytes <= limits.bytes) continue;
    std::error_code same_error, error;
    if (fs::equivalent(one.path, current, same_error)) continue;
    if (!fs::remove(one.path, error)) continue;
    bytes -= one.bytes;
    spdlog::info("recording {} removed: {}", one.path.string(),
                 too_old ? "older than telemetry.keep_days" : "more than telemetry.keep_mb");
  }
  return bytes;
}

}  // namespace heel
