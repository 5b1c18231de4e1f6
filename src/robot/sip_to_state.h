// A SIP's flags, bumpers, battery and sonars as the control stage reads them. Position and speed: odometry.h.
#pragma once

#include "arcos/sip.h"
#include "core/robot_model.h"
#include "heel/flow.h"

namespace heel {

void copy_status(const arcos::Sip& sip, RobotState& state);

/// `t_ns` is the stamp of the SIP's first byte. Readings of sonars that `model` does not have are left out.
void copy_sonar(const arcos::Sip& sip, const RobotModel& model, TimeNs t_ns, RobotState& state);

}  // namespace heel
