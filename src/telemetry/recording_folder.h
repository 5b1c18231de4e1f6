// The folder of recordings: which of them are kept.
#pragma once

#include <cstdint>
#include <string>

#include "heel/time.h"

namespace heel {

struct KeepLimits {
  std::uint64_t bytes = 0;  ///< of all recordings together
  TimeNs age_ns = 0;
};

/// Removes recordings of heeld (heel-DATE.mcap), the oldest first, until both limits hold; `current` is never
/// removed. Logs each one. Returns the bytes of those that are left.
std::uint64_t remove_old_recordings(const std::string& folder, const std::string& current,
                                    const KeepLimits& limits);

}  // namespace heel
