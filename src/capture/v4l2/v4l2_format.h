// Format and frame rate of a V4L2 device.
#pragma once

#include "capture/v4l2/v4l2_setup.h"

namespace heel {

/// Sets format, size and rate and checks what the device makes of it. "auto" takes the first of GREY, NV12,
/// YUYV, MJPG (in the order of the work they make) that reaches the rate, else the fastest.
void agree_on_format(V4l2Device& device, const CameraConfig& config, V4l2Agreement& agreement);

}  // namespace heel
