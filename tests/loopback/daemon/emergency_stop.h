// When an emergency stop reached the control loop, by the recording.
#pragma once

#include <string>

#include "files/csv_table.h"

namespace heel::test {

/// The rows of ticks.csv from the time on until the one whose request is the emergency stop of that time.
struct EmergencyStop {
  int ticks_before = 0;  ///< that began after the request and did not have it
  bool found = false;
  std::string state;
  double v_m_s = 1.0, yaw_rate_rad_s = 1.0;
  double t_s = 0.0;        ///< of the tick that has it
  double latency_s = 0.0;  ///< from the request's time to that of the tick
};

inline EmergencyStop emergency_stop_after(const CsvTable& ticks, double t_asked_s) {
  EmergencyStop stop;
  for (std::size_t row = 0; row < ticks.rows(); ++row) {
    const double t_s = ticks.number(row, "t_s");
    if (t_s < t_asked_s) continue;
    const double t_request_s = ticks.number(row, "request_t_s");
    if (ticks.text(row, "request_command") != "estop" || t_request_s < t_asked_s) {
      ++stop.ticks_before;
      continue;
    }
    // Those between the client's question and the request's time are the way to heeld, not to the wheels.
    stop = {0,
            true,
            ticks.text(row, "state"),
            ticks.number(row, "command_v_m_s"),
            ticks.number(row, "command_yaw_rate_rad_s"),
            t_s,
            t_s - t_request_s};
    for (std::size_t before = 0; before < row; ++before)
      stop.ticks_before += ticks.number(before, "t_s") > t_request_s;
    return stop;
  }
  return stop;
}

}  // namespace heel::test
