// Makes the source for a camera address, e.g. a V4l2Source for v4l2:/dev/video0.
#pragma once

#include <memory>

#include "capture/frame_source.h"
#include "core/config.h"

namespace heel {

/// Makes the source and does not open it. Throws heel::Error for a bad address or a kind that this build does
/// not have.
std::unique_ptr<FrameSource> make_frame_source(const CameraConfig& config);

/// Makes and opens the source. Throws heel::Error with the problem when it does not open.
std::unique_ptr<FrameSource> open_frame_source(const CameraConfig& config);

}  // namespace heel
