// The module's only export.
#include "capture/file/file_source.h"
#include "core/config.h"

extern "C" [[gnu::visibility("default")]] heel::FrameSource* heel_make_frame_source(
    const std::string& rest, const heel::CameraConfig& config) {
  return new heel::FileSource(rest, config.rate_hz, config.file_speed);
}
