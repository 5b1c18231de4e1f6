// A camera whose pictures are turned before anything else sees them: camera.rotate and camera.mirror.
#pragma once

#include <cstdint>
#include <memory>

#include "capture/frame_source.h"
#include "core/picture_turn.h"

namespace heel {

/// Gives the frames of `source`, turned. wait_frame() does not allocate for frames of up to the size that the
/// configuration asks for. Files and the simulator have their own size: where that is larger, it allocates
/// once, at the first frame.
class TurnedSource : public FrameSource {
 public:
  /// `width_px`, `height_px`: as `source` is asked for, before the turn.
  TurnedSource(std::unique_ptr<FrameSource> source, const PictureTurn& turn, std::uint32_t width_px,
               std::uint32_t height_px);

  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override { source_->close(); }

 private:
  /// What the base class reports of this source is what it reports of the other.
  template <typename Result>
  Result reported(Result result);

  std::unique_ptr<FrameSource> source_;
  PictureTurner turner_;
};

}  // namespace heel
