// A recording's inputs through today's control stage: the same decisions to the bit, or where they differ.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "heel/flow.h"
#include "recording/flow_compare.h"
#include "recording/recording_reader.h"

namespace heel {

/// New values for keys of every configuration of the recording: "control.gain_yaw_1_s" and "1.2", as TOML
/// writes them.
using ReplaySettings = std::vector<std::pair<std::string, std::string>>;

/// A quantity that differs, over the whole recording.
struct QuantityDifference {
  std::uint64_t ticks = 0;  ///< in so many ticks
  std::uint64_t first_tick = 0;
  double largest = 0.0;  ///< of numbers
};

struct TickDifference {
  TickRecord recorded, replayed;
  std::vector<FieldDifference> fields;
};

struct ReplayResult {
  RecordingReport report;
  std::uint64_t ticks = 0;  ///< replayed
  std::uint64_t same = 0;   ///< of them, in every decision
  double duration_s = 0.0;  ///< of the replayed ticks
  std::optional<TickDifference> first;
  std::optional<TickDifference> first_command;  ///< the first whose command differs
  std::map<std::string, QuantityDifference> quantities;
  /// Why the replay ended before the recording, in one line; empty: it did not.
  std::string ended;

  bool all_same() const { return ticks > 0 && same == ticks && ended.empty(); }
};

struct ReplayOptions {
  ReplaySettings settings;
  /// The replay ends at the first command that differs: after it the robot would have moved differently, so
  /// that the recorded inputs answer no more.
  bool until_command_differs = false;
  /// Called with each tick.
  std::function<void(const TickRecord& recorded, const TickRecord& replayed)> on_tick;
};

/// Throws heel::Error when the recording cannot be read or its ticks cannot be replayed at all: it has none,
/// or its beginning or its configuration is missing.
ReplayResult replay_control(const std::string& recording, const ReplayOptions& options);

}  // namespace heel
