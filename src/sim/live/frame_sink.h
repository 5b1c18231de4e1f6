// Where the simulated camera's frames go: to readers of "sim:NAME", into a video device for anybody's
// program, or into a file for whoever can reach it, another machine among them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "heel/flow.h"

namespace heel::sim {

class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// `grey` is dense, of the header's size. Throws heel::Error when frames can no longer go there.
  virtual void put(const FrameHeader& header, const std::vector<std::uint8_t>& grey) = 0;
};

/// "sim:NAME", "v4l2:/dev/videoN" or "file:PICTURE.pgm", for frames of this size and rate. Throws heel::Error
/// naming the address, what is wrong and what was expected.
std::unique_ptr<FrameSink> open_frame_sink(const std::string& address, int width_px, int height_px,
                                           double rate_hz);

}  // namespace heel::sim
