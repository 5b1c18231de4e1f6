#include "replay/control_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "config/config_edit.h"
#include "config/config_load.h"
#include "config/config_table.h"
#include "control/control_stage.h"
#include "heel/error.h"
#include "models/robot_models.h"

namespace heel {
namespace {

/// A value of a command line: a number, true, false or a quoted text as it is; anything else is a text.
std::string toml_text(const std::string& value) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  const bool is_number = error == std::errc() && end == value.data() + value.size();
  const bool as_it_is = is_number || value == "true" || value == "false" || value.starts_with('"');
  return as_it_is ? value : '"' + value + '"';
}

/// The recording's configurations by their numbers, read before the ticks: a tick may stand before the one
/// that it ran with.
class Configurations final : public RecordingVisitor {
 public:
  Configurations(std::string file, const ReplaySettings& settings) : file_(std::move(file)) {
    for (const auto& [key, value] : settings) {
      if (!index_of_key(key))
        throw Error(fmt::format("--set {}: no such key (see docs/configuration.md)", key));
      changes_.push_back({key, "", toml_text(value)});
    }
  }
  void on_configuration(const ConfigurationText& configuration) override {
    texts_[configuration.number] = configuration.text;
  }
  bool wants(std::string_view topic) const override { return topic == "/heel/configuration"; }

  Config at(std::uint64_t number) const {
    const auto found = texts_.find(number);
    if (found == texts_.end())
      throw Error(
          fmt::format("{}: configuration {} is missing (the recording is damaged, or was cut off "
                      "before it was written)",
                      file_, number));
    const std::string name = fmt::format("{}: configuration {}", file_, number);
    const bool changed = !changes_.empty();
    return parse_config(changed ? edited_config_text(found->second, name, changes_) : found->second, name)
        .config;
  }

 private:
  const std::string file_;
  std::vector<ConfigChange> changes_;
  std::map<std::uint64_t, std::string> texts_;
};

class Replayer final : public RecordingVisitor {
 public:
  Replayer(const std::string& file, const Configurations& configurations, const ReplayOptions& options)
      : file_(file), configurations_(configurations), options_(options) {}

  void on_tick(const TickRecord& recorded) override;
  bool wants(std::string_view topic) const override { return topic == "/heel/tick"; }

  ReplayResult result;

 private:
  bool can_follow(const TickRecord& recorded);
  void compare(const TickRecord& recorded, const TickRecord& replayed);

  const std::string& file_;
  const Configurations& configurations_;
  const ReplayOptions& options_;
  std::optional<ControlStage> stage_;
  std::uint64_t configuration_ = 0;
  std::uint64_t next_tick_ = 0;
  TimeNs t_first_ns_ = 0;
};

/// Each tick needs the state that those before it leave.
bool Replayer::can_follow(const TickRecord& recorded) {
  if (!result.ended.empty()) return false;
  if (recorded.tick == next_tick_) return true;
  if (!stage_)
    throw Error(
        fmt::format("{}: its first tick is number {} (expected 0: what is decided depends on all ticks "
                    "before)",
                    file_, recorded.tick));
  result.ended = fmt::format(
      "after tick {} the recording goes on with tick {}: records were lost, and what "
      "came after cannot be replayed",
      next_tick_ - 1, recorded.tick);
  return false;
}

void Replayer::on_tick(const TickRecord& recorded) {
  if (!can_follow(recorded)) return;
  ++next_tick_;
  if (!stage_) {
    stage_.emplace(configurations_.at(0), robot_models());
    t_first_ns_ = recorded.input.now_ns;
  }
  while (configuration_ < recorded.configuration) stage_->reconfigure(configurations_.at(++configuration_));
  const TickRecord replayed = stage_->tick(recorded.input);
  ++result.ticks;
  result.duration_s = seconds_from_ns(recorded.input.now_ns - t_first_ns_);
  if (options_.on_tick) options_.on_tick(recorded, replayed);
  if (same_flow(recorded, replayed)) {
    ++result.same;
  } else {
    compare(recorded, replayed);
  }
}

void Replayer::compare(const TickRecord& recorded, const TickRecord& replayed) {
  TickDifference difference{recorded, replayed, flow_differences(recorded, replayed)};
  for (const FieldDifference& field : difference.fields) {
    QuantityDifference& quantity = result.quantities[field.name];
    if (quantity.ticks++ == 0) quantity.first_tick = recorded.tick;
    quantity.largest = std::max(quantity.largest, field.distance);  // a NaN changes nothing
  }
  const bool command =
      std::any_of(difference.fields.begin(), difference.fields.end(),
                  [](const FieldDifference& field) { return field.name.starts_with("command."); });
  if (!result.first) result.first = difference;
  if (!command || result.first_command) return;
  result.first_command = std::move(difference);
  if (options_.until_command_differs)
    result.ended = fmt::format(
        "tick {} gives another command: after it the robot would have moved differently, and the "
        "recording cannot answer",
        recorded.tick);
}

}  // namespace

ReplayResult replay_control(const std::string& recording, const ReplayOptions& options) {
  Configurations configurations(recording, options.settings);
  read_recording(recording, configurations);
  Replayer replayer(recording, configurations, options);
  RecordingReport report = read_recording(recording, replayer);
  if (replayer.result.ticks == 0)
    throw Error(fmt::format("{}: no control tick in this recording (nothing to replay)", recording));
  replayer.result.report = std::move(report);
  return std::move(replayer.result);
}

}  // namespace heel
