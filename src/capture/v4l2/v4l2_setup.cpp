#include "capture/v4l2/v4l2_setup.h"

#include <linux/videodev2.h>

#include <cstring>

#include "capture/v4l2/v4l2_controls.h"
#include "capture/v4l2/v4l2_format.h"

namespace heel {

namespace {

bool check_capabilities(V4l2Device& device, V4l2Agreement& agreement) {
  v4l2_capability capability{};
  if (const int error = device.control(VIDIOC_QUERYCAP, &capability); error != 0) {
    agreement.problem = std::string("is not a V4L2 device (") + std::strerror(error) + "); expected a camera";
    return false;
  }
  const auto* name = reinterpret_cast<const char*>(capability.card);
  agreement.card.assign(name, strnlen(name, sizeof(capability.card)));
  // A driver with several nodes says what the opened one can do in device_caps.
  const bool by_node = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t can = by_node ? capability.device_caps : capability.capabilities;
  if ((can & V4L2_CAP_VIDEO_CAPTURE) == 0) {
    agreement.problem =
        "'" + agreement.card + "' does not capture video here; expected the camera's other node";
    return false;
  }
  if ((can & V4L2_CAP_STREAMING) == 0) {
    agreement.problem = "'" + agreement.card + "' has no streaming I/O; expected a camera that has";
    return false;
  }
  return true;
}

}  // namespace

V4l2Agreement agree_with_device(V4l2Device& device, const CameraConfig& config) {
  V4l2Agreement agreement;
  if (!check_capabilities(device, agreement)) return agreement;
  agree_on_format(device, config, agreement);
  if (agreement.agreed) agreement.agreed = agree_on_controls(device, config, agreement);
  return agreement;
}

}  // namespace heel
