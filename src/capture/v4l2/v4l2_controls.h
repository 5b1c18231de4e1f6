// Exposure, focus and gain of a V4L2 device.
#pragma once

#include "capture/v4l2/v4l2_setup.h"

namespace heel {

/// Sets the values that the configuration fixes and reads them back; sets the others automatic where the
/// device can. False: the device has no such control or refuses the value; `setup.problem` says which.
bool set_up_controls(V4l2Device& device, const CameraConfig& config, V4l2Setup& setup);

}  // namespace heel
