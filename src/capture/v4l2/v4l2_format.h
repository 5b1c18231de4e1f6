// Format and frame rate of a V4L2 device.
#pragma once

#include <vector>

#include "capture/v4l2/v4l2_setup.h"

namespace heel {

/// Sets format, size and rate, and checks what the device has set. "auto" takes the first of pixel_formats()
/// that is not in `without` and reaches the rate, or else the fastest of them.
void set_up_format(V4l2Device& device, const CameraConfig& config, const std::vector<PixelFormat>& without,
                   V4l2Setup& setup);

}  // namespace heel
