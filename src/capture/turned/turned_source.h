// A camera whose pictures are turned before anything else sees them: camera.rotate and camera.mirror.
#pragma once

#include <memory>

#include "capture/frame_source.h"
#include "core/picture_turn.h"

namespace heel {

/// Gives the frames of `source`, turned. Allocates in wait_frame() only when the size of the frames changes.
class TurnedSource : public FrameSource {
 public:
  TurnedSource(std::unique_ptr<FrameSource> source, const PictureTurn& turn);

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
