// Frames for lock step: rendered by the world, or read from a video one by one.
#pragma once

#include <memory>
#include <vector>

#include "capture/frame_source.h"
#include "sim/scene/world.h"

namespace heel::sim {

class FrameSupply {
 public:
  virtual ~FrameSupply() = default;
  /// The frame whose exposure is centred on `t_ns`, or a view without pixels at the end of a video.
  virtual FrameView frame(std::uint64_t sequence, TimeNs t_ns, const RobotMotion& robot) = 0;
};

/// `world` must outlive the supply.
std::unique_ptr<FrameSupply> make_world_supply(World& world);
/// `source` is "file:VIDEO". Throws heel::Error when it cannot be opened.
std::unique_ptr<FrameSupply> make_file_supply(const std::string& source, int width_px, int height_px);

}  // namespace heel::sim
