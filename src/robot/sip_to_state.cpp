#include "robot/sip_to_state.h"

#include "robot/wire_units.h"

namespace heel {

void copy_status(const arcos::Sip& sip, RobotState& state) {
  state.has_sip = true;
  state.motors_enabled = (sip.flags & arcos::kFlagMotorsEnabled) != 0;
  state.stop_button = (sip.flags & arcos::kFlagStopButton) != 0;
  state.e_stall = (sip.flags & arcos::kFlagEStall) != 0;
  state.stall_left = sip.stall_left();
  state.stall_right = sip.stall_right();
  state.bumpers_front = sip.bumpers_front();
  state.bumpers_rear = sip.bumpers_rear();
  // The long field goes on above 25.5 V; some robots send it and leave it 0.
  const int long_dv = sip.battery_long_dv.value_or(0);
  state.battery_v = (long_dv > 0 ? long_dv : sip.battery_dv) * wire::kVoltsPerDecivolt;
}

void copy_sonar(const arcos::Sip& sip, const RobotModel& model, TimeNs t_ns, RobotState& state) {
  const double metres_per_unit = model.mm_per_range_unit * wire::kMetresPerMm;
  for (std::size_t i = 0; i < sip.sonar_count; ++i) {
    const arcos::SonarReading& reading = sip.sonars[i];
    if (model.geometry.has_sonar(reading.number))
      state.sonar[reading.number] = {t_ns, reading.range_mm * metres_per_unit};
  }
}

}  // namespace heel
