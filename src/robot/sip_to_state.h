// A SIP's flags, bumpers and battery as the control stage reads them. Position and speed: odometry.h.
#pragma once

#include "arcos/sip.h"
#include "heel/flow.h"

namespace heel {

void copy_status(const arcos::Sip& sip, RobotState& state);

}  // namespace heel
