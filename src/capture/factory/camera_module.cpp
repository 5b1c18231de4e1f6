#include "capture/factory/camera_module.h"

#include <fmt/format.h>

#include "shared_module/shared_module.h"

namespace heel {

std::unique_ptr<FrameSource> source_of_module(const std::string& kind, const std::string& rest,
                                              const CameraConfig& config) {
  void* const entry =
      module_entry("camera-" + kind, kCameraModuleEntry, fmt::format("camera address '{}'", config.source));
  return std::unique_ptr<FrameSource>(reinterpret_cast<CameraModuleEntry*>(entry)(rest, config));
}

}  // namespace heel
