#include "capture/v4l2/v4l2_setup.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <cstring>

#include "capture/v4l2/v4l2_controls.h"
#include "capture/v4l2/v4l2_format.h"

namespace heel {

namespace {

bool check_capabilities(V4l2Device& device, V4l2Setup& setup) {
  v4l2_capability capability{};
  if (const int error = device.control(VIDIOC_QUERYCAP, &capability); error != 0) {
    setup.problem = fmt::format("is not a V4L2 device: {} (expected a camera)", std::strerror(error));
    return false;
  }
  const auto* name = reinterpret_cast<const char*>(capability.card);
  setup.card.assign(name, strnlen(name, sizeof(capability.card)));
  // A driver with several nodes gives the capabilities of the open one in device_caps.
  const bool by_node = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t can = by_node ? capability.device_caps : capability.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    setup.problem = fmt::format(
        "'{}' does not capture video at this node (expected another node of the camera)", setup.card);
    return false;
  }
  if ((can & V4L2_CAP_STREAMING) == 0) {
    setup.problem = fmt::format("'{}' has no streaming I/O (expected a camera that has it)", setup.card);
    return false;
  }
  return true;
}

}  // namespace

V4l2Setup set_up_device(V4l2Device& device, const CameraConfig& config,
                        const std::vector<PixelFormat>& without) {
  V4l2Setup setup;
  if (!check_capabilities(device, setup)) return setup;
  set_up_format(device, config, without, setup);
  if (setup.complete) setup.complete = set_up_controls(device, config, setup);
  return setup;
}

}  // namespace heel
