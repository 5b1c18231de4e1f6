#include "recording/bundle.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>

#include "files/atomic_file.h"
#include "heel/error.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_writer.h"
#include "recording/private_wire.h"
#include "recording/recording_reader.h"
#include "recording/redacted_message.h"

namespace heel {
namespace {

constexpr std::string_view kPictures = "/camera", kWire = "/heel/wire";

/// What an attempt leaves out.
struct Selection {
  std::set<std::string_view> without;  ///< topics
  TimeNs t_begin_ns = 0;               ///< earlier messages, but for the configuration
  std::string left_out;                ///< in words
};

struct TimeRange {
  TimeNs begin_ns = 0, end_ns = 0;
};

/// The bundle as bytes, or nothing when it has become too large.
class Bundler {
 public:
  Bundler(const std::string& recording, const BundleOptions& options)
      : recording_(recording), options_(options) {
    find_names_on_the_wire();
  }

  std::optional<std::string> attempt(const Selection& selection);
  /// Of the messages that the last attempt read.
  TimeRange range() const { return range_; }
  const std::vector<std::string>& problems() const { return problems_; }

 private:
  std::ifstream opened() const;
  void find_names_on_the_wire();
  std::optional<std::string> without_names(const std::string& topic, std::string_view json);
  void copy_messages(McapReader& reader, McapWriter& writer, const Selection& selection);
  void attach_files(const McapReader& reader, McapWriter& writer) const;

  const std::string& recording_;
  const BundleOptions& options_;
  PrivateWire wire_;
  std::size_t wire_messages_ = 0;  // that this attempt has read
  std::string bytes_;
  bool too_large_ = false;
  TimeRange range_;
  std::vector<std::string> problems_;
};

std::ifstream Bundler::opened() const {
  std::ifstream file(recording_, std::ios::binary);
  if (!file)
    throw Error(fmt::format("{}: cannot read: {} (expected a recording)", recording_, std::strerror(errno)));
  return file;
}

void Bundler::find_names_on_the_wire() {
  std::ifstream file = opened();
  McapReader reader(file, recording_);
  for (McapMessage message; reader.next(message);)
    if (reader.channel(message.channel).topic == kWire) wire_.add(message.data);
  wire_.finish();
}

/// To be asked for each message that is read. Nothing: it is left out.
std::optional<std::string> Bundler::without_names(const std::string& topic, std::string_view json) {
  if (topic == kWire) return wire_.without_names(wire_messages_++, json);
  return redacted_message(options_.redaction, topic, json);
}

std::optional<std::string> Bundler::attempt(const Selection& selection) {
  std::ifstream file = opened();
  bytes_.clear();
  too_large_ = false;
  McapReader reader(file, recording_);
  McapWriter writer(
      [this](std::string_view piece) {
        too_large_ = too_large_ || bytes_.size() + piece.size() > options_.max_bytes;
        if (!too_large_) bytes_.append(piece);
        return !too_large_;
      },
      {.library = "heel bundle", .compression_level = 9});
  copy_messages(reader, writer, selection);
  attach_files(reader, writer);
  writer.finish();
  problems_ = reader.problems();
  if (too_large_) return std::nullopt;
  return std::move(bytes_);
}

void Bundler::copy_messages(McapReader& reader, McapWriter& writer, const Selection& selection) {
  std::map<std::uint16_t, std::uint16_t> channels;  // of the recording, of the bundle
  range_ = {};
  wire_messages_ = 0;
  for (McapMessage message; reader.next(message);) {
    range_.begin_ns = range_.end_ns == 0 ? message.t_log_ns : std::min(range_.begin_ns, message.t_log_ns);
    range_.end_ns = std::max(range_.end_ns, message.t_log_ns);
    const McapChannel& channel = reader.channel(message.channel);
    const bool early = message.t_log_ns < selection.t_begin_ns && channel.topic != "/heel/configuration";
    const std::optional<std::string> json = without_names(channel.topic, message.data);
    if (!json || too_large_ || early || selection.without.contains(channel.topic)) continue;
    auto known = channels.find(message.channel);
    if (known == channels.end()) {
      const McapSchema* const schema = reader.schema(channel.schema);
      const std::uint16_t schema_id = schema == nullptr
                                          ? std::uint16_t{0}
                                          : writer.add_schema(schema->name, schema->encoding, schema->text);
      known =
          channels.emplace(message.channel, writer.add_channel(channel.topic, schema_id, channel.encoding))
              .first;
    }
    writer.write(known->second, message.t_log_ns, *json);
  }
}

void Bundler::attach_files(const McapReader& reader, McapWriter& writer) const {
  if (options_.with_pictures) {
    for (const auto& [name, file] : reader.attachments())
      writer.add_attachment(name, file.media_type, file.data, 0);
  }
  for (const auto& [name, text] : options_.texts)
    writer.add_attachment(name, "text/plain", options_.redaction.applied(text), 0);
}

}  // namespace

BundleReport write_bundle(const std::string& recording, const std::string& bundle,
                          const BundleOptions& options) {
  std::vector<Selection> selections;
  if (options.with_pictures) selections.push_back({});
  const std::string no_pictures = options.with_pictures ? "the pictures" : "";
  const std::string and_ = options.with_pictures ? "the pictures, " : "";
  selections.push_back({{kPictures}, 0, no_pictures});
  selections.push_back({{kPictures, kWire}, 0, and_ + "the bytes on the wire"});
  selections.push_back({{kPictures, kWire, "/heel/pose"}, 0, and_ + "the bytes on the wire, the poses"});
  Bundler bundler(recording, options);
  std::optional<std::string> bytes;
  Selection chosen;
  for (std::size_t i = 0; !bytes && i < selections.size(); ++i) {
    chosen = selections[i];
    bytes = bundler.attempt(chosen);
  }
  // Then the last half, quarter … of the run.
  constexpr int kHalves = 12;
  const TimeRange range = bundler.range();
  for (int half = 1; !bytes && half <= kHalves; ++half) {
    const TimeNs kept_ns = (range.end_ns - range.begin_ns) >> half;
    chosen.t_begin_ns = range.end_ns - kept_ns;
    chosen.left_out = selections.back().left_out +
                      fmt::format(", all but the last {:.0f} s, which `heel replay` cannot repeat",
                                  seconds_from_ns(kept_ns));
    bytes = bundler.attempt(chosen);
  }
  if (!bytes)
    throw Error(
        fmt::format("{}: the texts alone are more than {} MB", bundle, options.max_bytes / 1'000'000));
  write_file_atomically(bundle, *bytes);
  BundleReport report{bytes->size(), bundler.problems()};
  if (!chosen.left_out.empty())
    report.left_out.push_back(fmt::format("left out because of the size: {}", chosen.left_out));
  return report;
}

std::string recording_in_first_of(const std::vector<std::string>& folders) {
  std::string why_not;
  for (const std::string& folder : folders) {
    std::error_code error;
    if (!std::filesystem::is_directory(folder, error)) {
      why_not += fmt::format("{}: {}; ", folder, error ? error.message() : "not a folder");
      continue;
    }
    try {
      return recording_in(folder);
    } catch (const Error& none) {
      why_not += fmt::format("{}; ", none.what());
    }
  }
  throw Error(why_not + "no recording of the service (expected one there, or a recording as argument)");
}

}  // namespace heel
