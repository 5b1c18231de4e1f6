// Where the simulated camera's frames go: to readers of "sim:NAME" on this machine, into a video device that
// any program can read, or into a picture file, which another machine can read as well.
#pragma once

#include <memory>
#include <string>

#include "heel/flow.h"

namespace heel::sim {

class FrameSink {
 public:
  virtual ~FrameSink() = default;
  /// The rows of `frame` have no gaps. Throws heel::Error when frames can no longer be
  /// delivered.
  virtual void put(const FrameView& frame) = 0;
};

/// Opens "sim:NAME", "v4l2:/dev/videoN" or "file:PICTURE.pgm" for frames of this size and rate. Throws
/// heel::Error naming the address, what is wrong and what was expected.
std::unique_ptr<FrameSink> open_frame_sink(const std::string& address, int width_px, int height_px,
                                           double rate_hz);

}  // namespace heel::sim
