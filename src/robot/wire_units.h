// Conversion between ARCOS wire units and SI units, as far as it is the same on all robots; what differs is
// in RobotModel. All code that converts uses these.
#pragma once

#include <numbers>

namespace heel::wire {

inline constexpr double kMetresPerMm = 1e-3;
inline constexpr double kRadPerDeg = std::numbers::pi / 180.0;

/// XPOS and YPOS count modulo 2^15: some firmware keeps the sixteenth bit, some does not.
inline constexpr int kPositionUnitsPerWrap = 1 << 15;

inline constexpr double kVoltsPerDecivolt = 0.1;

constexpr double mm_s_from_m_s(double v_m_s) {
  return v_m_s / kMetresPerMm;
}
constexpr double deg_s_from_rad_s(double rate_rad_s) {
  return rate_rad_s / kRadPerDeg;
}

/// The difference a − b of two counters that wrap, as the nearest representative: −modulus/2 … modulus/2 − 1.
constexpr int wrapped_difference(int a, int b, int modulus) {
  const int reduced = ((a - b) % modulus + modulus) % modulus;
  return reduced < modulus / 2 ? reduced : reduced - modulus;
}

}  // namespace heel::wire
