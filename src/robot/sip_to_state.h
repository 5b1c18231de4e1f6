// A SIP's flags, bumpers, battery and sonars as the control stage reads them. Position and speed: odometry.h.
#pragma once

#include "arcos/sip.h"
#include "heel/flow.h"

namespace heel {

void copy_status(const arcos::Sip& sip, RobotState& state);

/// `t_ns` is the stamp of the SIP's first byte.
void copy_sonar(const arcos::Sip& sip, TimeNs t_ns, RobotState& state);

}  // namespace heel
