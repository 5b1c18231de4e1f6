// When the wheels of a simulated robot do what a command asks: from heel-sim's truth, which has the time of
// CLOCK_MONOTONIC.
//
// Units: m/s; times of CLOCK_MONOTONIC.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "heel/time.h"

namespace heel::evaluation {

class WheelResponse {
 public:
  /// Smaller changes are not told from noise.
  static constexpr double kLeastChange_m_s = 0.005;
  /// What comes later is not the response to this command.
  static constexpr TimeNs kLongest_ns = kNsPerS;

  /// Reads the columns t_monotonic_s, wheel_left_m_s and wheel_right_m_s. Throws heel::Error naming the file
  /// and what is wrong in it.
  explicit WheelResponse(const std::string& truth_csv);

  /// When the mean speed of the wheels has made half of the change of a command that was written at
  /// `t_written_ns`. Nothing: the change is too small, the wheels were beyond the half already, or do not get
  /// there; and outside of the file's times.
  std::optional<TimeNs> half_way_ns(TimeNs t_written_ns, double from_m_s, double to_m_s) const;

 private:
  struct Sample {
    TimeNs t_ns;
    double v_m_s;
  };
  std::vector<Sample> samples_;
};

}  // namespace heel::evaluation
