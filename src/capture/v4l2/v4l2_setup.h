// Sets up an open V4L2 device: checks its capabilities, and sets the format, the rate and the controls that
// the configuration requests. Each is read back. The device does not stream yet.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "capture/pixel_format.h"
#include "capture/v4l2/v4l2_device.h"
#include "core/config.h"

namespace heel {

/// The set-up of a device, or why it failed.
struct V4l2Setup {
  bool complete = false;
  bool busy = false;       ///< not complete because another program streams from the device
  bool none_left = false;  ///< not complete because every format was left out
  std::string problem;     ///< one line without the address, unless complete

  PixelFormat format = PixelFormat::Grey;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::uint32_t stride_bytes = 0;  ///< 0 for MJPG
  bool interlaced = false;         ///< a frame holds two fields of different times, row by row in turn
  double rate_hz = 0.0;            ///< 0: unknown to the device
  double exposure_s = 0.0;         ///< fixed exposure as read back; 0: automatic
  std::string card;                ///< the device's own name
  std::string controls;            ///< the fixed controls, e.g. "exposure (ms) 5, gain 20"
};

/// `without`: formats that are not tried where the configuration leaves the format free.
V4l2Setup set_up_device(V4l2Device& device, const CameraConfig& config,
                        const std::vector<PixelFormat>& without = {});

}  // namespace heel
