// The module's only export.
#include "capture/libcamera/libcamera_source.h"
#include "core/config.h"

extern "C" [[gnu::visibility("default")]] heel::FrameSource* heel_make_frame_source(
    const std::string& rest, const heel::CameraConfig& config) {
  return new heel::LibcameraSource(rest, config);
}
