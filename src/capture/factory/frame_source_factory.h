// From a camera address to the source that serves it, e.g. v4l2:/dev/video0 to a V4l2Source.
#pragma once

#include <memory>

#include "capture/frame_source.h"
#include "core/config.h"

namespace heel {

/// Makes the source without opening it. Throws heel::Error on a bad address or a kind this build lacks.
std::unique_ptr<FrameSource> make_frame_source(const CameraConfig& config);

/// Makes and opens it. Throws heel::Error with the problem when it does not open.
std::unique_ptr<FrameSource> open_frame_source(const CameraConfig& config);

}  // namespace heel
