// The sources whose libraries are loaded only when a camera address asks for them (src/shared_module).
#pragma once

#include <memory>
#include <string>

#include "capture/frame_source.h"
#include "core/config.h"

namespace heel {

/// What a module exports under the name kCameraModuleEntry. `rest`: of the address, after its colon. The
/// caller owns the source.
using CameraModuleEntry = FrameSource*(const std::string& rest, const CameraConfig& config);
inline constexpr const char* kCameraModuleEntry = "heel_make_frame_source";

/// The source of the module for this kind of camera, "file" or "libcamera". Throws heel::Error, which names
/// the module's file, when it cannot be loaded.
std::unique_ptr<FrameSource> source_of_module(const std::string& kind, const std::string& rest,
                                              const CameraConfig& config);

}  // namespace heel
