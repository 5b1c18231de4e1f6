// Coming to terms with a V4L2 device: what it must be able to do, the format, the rate and the controls asked
// for by the configuration, each set and read back. The device is open; nothing streams yet.
#pragma once

#include <cstdint>
#include <string>

#include "capture/pixel_format.h"
#include "capture/v4l2/v4l2_device.h"
#include "core/config.h"

namespace heel {

/// What was agreed, or what stands in the way.
struct V4l2Agreement {
  bool agreed = false;
  std::string problem;  ///< one line without the address, when not agreed

  PixelFormat format = PixelFormat::Grey;
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  std::uint32_t stride_bytes = 0;  ///< 0 for MJPG
  double rate_hz = 0.0;            ///< 0: the device does not say
  double exposure_s = 0.0;         ///< fixed exposure as read back; 0: automatic
  std::string card;                ///< the device's own name
  std::string controls;            ///< what was fixed, e.g. "exposure 5 ms, gain 20"
};

V4l2Agreement agree_with_device(V4l2Device& device, const CameraConfig& config);

}  // namespace heel
