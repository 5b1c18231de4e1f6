// Exposure, focus and gain of a V4L2 device.
#pragma once

#include "capture/v4l2/v4l2_setup.h"

namespace heel {

/// Fixes what the configuration fixes and reads it back; what it leaves automatic is set automatic where the
/// device can. False: the device lacks a control that is asked for, or refuses the value; problem is set.
bool agree_on_controls(V4l2Device& device, const CameraConfig& config, V4l2Agreement& agreement);

}  // namespace heel
