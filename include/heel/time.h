/// \file
/// Time inside heel: one monotonic clock, passed as an argument, never read by a stage.
///
/// - Units: nanoseconds as signed 64-bit integers, from the origin of the clock.
#pragma once

#include <cstdint>

namespace heel {

/// Nanoseconds of CLOCK_MONOTONIC in the daemon; nanoseconds of virtual time in lock step.
using TimeNs = std::int64_t;

inline constexpr TimeNs kNsPerUs = 1'000;
inline constexpr TimeNs kNsPerMs = 1'000'000;
inline constexpr TimeNs kNsPerS = 1'000'000'000;

constexpr double seconds_from_ns(TimeNs t_ns) {
  return static_cast<double>(t_ns) * 1e-9;
}
constexpr TimeNs ns_from_seconds(double t_s) {
  return static_cast<TimeNs>(t_s * 1e9);
}

}  // namespace heel
