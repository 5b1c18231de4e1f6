#include "telemetry/recorder.h"

#include <fmt/chrono.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/wire_pieces.h"
#include "heel/error.h"
#include "realtime/clock.h"
#include "recording/flow_json.h"
#include "recording/recording_reader.h"
#include "recording/viewer_messages.h"
#include "telemetry/event_text.h"

namespace heel {

namespace fs = std::filesystem;

namespace {
constexpr std::uint64_t kTicksPerView = 5;
}

RecordingClock RecordingClock::wall() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return {std::chrono::duration_cast<std::chrono::nanoseconds>(now).count() - monotonic_now_ns()};
}

Recorder::Recorder(const std::string& path, RecordingClock clock)
    : clock_(clock),
      file_(path),
      writer_([this](std::string_view piece) { return file_.append(piece); }, {}) {
  for (const TopicRow& row : topic_table()) {
    const std::uint16_t schema = writer_.add_schema(std::string(row.schema), "jsonschema", row.schema_text());
    channels_[static_cast<std::size_t>(row.topic)] = writer_.add_channel(std::string(row.name), schema);
  }
  file_.flush();
}

Recorder::~Recorder() {
  writer_.finish();
  file_.flush();
}

void Recorder::write(Topic topic, TimeNs t_ns, std::string_view json) {
  writer_.write(channels_[static_cast<std::size_t>(topic)], t_ns + clock_.offset_ns, json);
}

template <typename Flow>
void Recorder::write_flow(Topic topic, TimeNs t_ns, const Flow& record) {
  json_.clear();
  append_flow_json(json_, record);
  write(topic, t_ns, json_);
}

void Recorder::record(const TickRecord& tick) {
  write_flow(Topic::Tick, tick.input.now_ns, tick);
  if (tick.tick % kTicksPerView == 0) record_view(tick);
}

/// For viewers, ten times a second.
void Recorder::record_view(const TickRecord& tick) {
  const TimeNs t_ns = tick.input.now_ns;
  for (const auto& [topic, append] : {std::pair(Topic::Transform, &append_robot_transform),
                                      std::pair(Topic::Person, &append_person_pose)}) {
    json_.clear();
    append(json_, tick, t_ns + clock_.offset_ns);
    if (!json_.empty()) write(topic, t_ns, json_);
  }
}

void Recorder::record(const PoseEstimate& pose) {
  write_flow(Topic::Pose, pose.t_done_ns, pose);
}

void Recorder::record(const CaptureCounters& capture) {
  write_flow(Topic::Capture, capture.t_ns, capture);
}

void Recorder::record(const Event& event) {
  write_flow(Topic::Event, event.t_ns, event);
}

void Recorder::record(const WireBytes& bytes) {
  write_flow(Topic::Wire, bytes.t_ns, bytes);
}

void Recorder::record(const FrameTiming& timing) {
  write_flow(Topic::Timing, timing.t_done_ns, timing);
}

void Recorder::record_wire(std::span<const std::uint8_t> bytes, bool to_robot, TimeNs t_ns) {
  for_each_wire_piece(bytes, to_robot, t_ns, [this](const WireBytes& piece) { record(piece); });
}

void Recorder::record(const ConfigurationText& configuration) {
  write(Topic::Configuration, configuration.t_ns, configuration_json(configuration));
}

void Recorder::record(const OperatorLine& line) {
  write(Topic::Operator, line.t_ns, operator_json(line));
}

void Recorder::record(const RecordingNote& note) {
  write(Topic::Recording, note.t_ns, note_json(note));
}

void Recorder::record(const RecordedPicture& picture) {
  json_.clear();
  append_picture_json(json_, picture, picture.header.t_capture_ns + clock_.offset_ns);
  write(Topic::Picture, picture.header.t_capture_ns, json_);
}

void Recorder::attach(const std::string& name, const std::string& media_type, std::string_view content) {
  if (!writer_.add_attachment(name, media_type, content, clock_.offset_ns))
    spdlog::error("recording {}: the attachment {} ({} bytes) could not be written and is missing", path(),
                  name, content.size());
}

void Recorder::record_text(TimeNs t_ns, std::string_view text) {
  write(Topic::Log, t_ns, log_json({t_ns, std::string(text)}, t_ns + clock_.offset_ns));
}

void Recorder::flush() {
  writer_.end_chunk();
  file_.flush();
}

void Recorder::sync() {
  writer_.end_chunk();
  file_.sync();
}

bool Recorder::finish() {
  writer_.finish();
  file_.sync();
  return !file_.failing() && file_.pieces_lost() == 0;
}

std::string new_recording_path(const std::string& folder, const std::string& suffix) {
  try {
    fs::create_directories(folder);
    const std::string stem =
        fmt::format("{}/heel-{:%Y%m%dT%H%M%S}Z", folder, fmt::gmtime(std::time(nullptr)));
    std::string path = stem + suffix + kRecordingExtension;
    for (int number = 1; fs::exists(path); ++number)
      path = fmt::format("{}-{}{}{}", stem, number, suffix, kRecordingExtension);
    return path;
  } catch (const fs::filesystem_error& error) {
    throw Error("telemetry.directory " + folder + ": " + error.code().message() +
                " (expected a folder that can be written)");
  }
}

}  // namespace heel
