#include "recording/recording_reader.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <type_traits>

#include "heel/error.h"
#include "mcap/mcap_reader.h"
#include "recording/flow_json.h"
#include "recording/topics.h"

namespace heel {
namespace fs = std::filesystem;
namespace {

/// From a message's text to the call of the visitor.
class Dispatcher {
 public:
  Dispatcher(const std::string& file, RecordingVisitor& visitor, std::set<std::string>& other_version)
      : file_(file), visitor_(visitor), other_version_(other_version) {}

  void dispatch(const TopicRow& row, const McapMessage& message) {
    switch (row.topic) {
      case Topic::Tick:
        return visitor_.on_tick(flow<TickRecord>(row, message));
      case Topic::Pose:
        return visitor_.on_pose(flow<PoseEstimate>(row, message));
      case Topic::Capture:
        return visitor_.on_capture(flow<CaptureCounters>(row, message));
      case Topic::Event:
        return visitor_.on_event(flow<Event>(row, message));
      case Topic::Wire:
        return visitor_.on_wire(flow<WireBytes>(row, message));
      case Topic::Timing:
        return visitor_.on_timing(flow<FrameTiming>(row, message));
      case Topic::Log:
        return visitor_.on_log(decoded(row, message, log_from_json));
      case Topic::Configuration:
        return visitor_.on_configuration(decoded(row, message, configuration_from_json));
      case Topic::Operator:
        return visitor_.on_operator(decoded(row, message, operator_from_json));
      case Topic::Recording:
        return visitor_.on_note(decoded(row, message, note_from_json));
      case Topic::Picture:
        return visitor_.on_picture(decoded(row, message, picture_from_json));
      case Topic::Transform:
      case Topic::Person:
        return;  // the ticks say it
    }
  }

 private:
  /// What the visitor itself throws says nothing of the message.
  template <typename Decode>
  std::invoke_result_t<const Decode&, std::string_view> decoded(const TopicRow& row,
                                                                const McapMessage& message,
                                                                const Decode& decode) {
    try {
      return decode(message.data);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: message {} of {}: {}", file_, message.sequence, row.name, error.what()));
    }
  }
  template <typename Flow>
  Flow flow(const TopicRow& row, const McapMessage& message) {
    return decoded(row, message, [&](std::string_view json) {
      std::set<std::string> names;
      Flow record = flow_from_json<Flow>(json, names);
      for (const std::string& name : names) other_version_.insert(std::string(row.name) + name);
      return record;
    });
  }

  const std::string& file_;
  RecordingVisitor& visitor_;
  std::set<std::string>& other_version_;
};

const TopicRow* topic_of(const std::string& name) {
  for (const TopicRow& row : topic_table())
    if (row.name == name) return &row;
  return nullptr;
}

std::ifstream opened(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error(fmt::format("{}: cannot read: {} (expected a recording)", path, std::strerror(errno)));
  return file;
}

}  // namespace

void require_recording(const std::string& path) {
  std::ifstream file = opened(path);
  const McapReader reader(file, path);
}

RecordingReport read_recording(const std::string& path, RecordingVisitor& visitor) {
  std::ifstream file = opened(path);
  RecordingReport report;
  report.file = path;
  McapReader reader(file, path);
  Dispatcher dispatcher(path, visitor, report.other_version);
  std::map<std::uint16_t, const TopicRow*> wanted;
  for (McapMessage message; reader.next(message);) {
    auto found = wanted.find(message.channel);
    if (found == wanted.end()) {
      const TopicRow* row = topic_of(reader.channel(message.channel).topic);
      if (row != nullptr && !visitor.wants(row->name)) row = nullptr;
      found = wanted.emplace(message.channel, row).first;
    }
    if (found->second == nullptr) continue;
    dispatcher.dispatch(*found->second, message);
    ++report.messages;
  }
  report.complete = reader.complete();
  for (const auto& [name, attachment] : reader.attachments()) report.attachments[name] = attachment.data;
  report.problems = reader.problems();
  return report;
}

std::string recording_in(const std::string& file_or_folder) {
  std::error_code error;
  if (!fs::is_directory(file_or_folder, error)) return file_or_folder;
  const fs::directory_iterator entries(file_or_folder, error);
  if (error) throw Error(fmt::format("{}: cannot read the folder: {}", file_or_folder, error.message()));
  fs::path newest;
  fs::file_time_type t_newest;
  for (const auto& entry : entries) {
    if (entry.path().extension() != kRecordingExtension) continue;
    const auto t = entry.last_write_time();
    if (!newest.empty() && (t < t_newest || (t == t_newest && entry.path() < newest))) continue;
    newest = entry.path();
    t_newest = t;
  }
  if (newest.empty())
    throw Error(fmt::format("{}: no recording in this folder (expected a file *{})", file_or_folder,
                            kRecordingExtension));
  return newest.string();
}

}  // namespace heel
