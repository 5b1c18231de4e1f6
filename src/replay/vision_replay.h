// A recording's pictures through today's vision: the same poses to the bit, or the first frame that differs.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "heel/flow.h"
#include "recording/flow_compare.h"

namespace heel {

struct VisionReplayResult {
  std::uint64_t frames = 0;             ///< replayed
  std::uint64_t same = 0;               ///< of them, in everything but the time at which vision was done
  std::optional<PoseEstimate> first;    ///< the first recorded pose that differs …
  std::vector<FieldDifference> fields;  ///< … in these
  std::map<std::string, std::uint64_t> quantities;  ///< what differs, and in how many frames
  /// Why it was not replayed, or ended before the recording, in one line; empty: it was, to its end.
  std::string ended;

  bool all_same() const { return same == frames; }
};

/// Throws heel::Error when the recording cannot be read.
VisionReplayResult replay_vision(const std::string& recording);

}  // namespace heel
