#include "capture/turned/turned_source.h"

#include <fmt/format.h>

#include <utility>

namespace heel {

TurnedSource::TurnedSource(std::unique_ptr<FrameSource> source, const PictureTurn& turn,
                           std::uint32_t width_px, std::uint32_t height_px)
    : FrameSource(source->address()), source_(std::move(source)), turner_(turn) {
  turner_.reserve(width_px, height_px);
}

template <typename Result>
Result TurnedSource::reported(Result result) {
  problem_ = source_->problem();
  counters_ = source_->counters();
  return result;
}

OpenResult TurnedSource::open() {
  const OpenResult result = source_->open();
  const PictureTurn& turn = turner_.turn();
  description_ = fmt::format("{}{}{}", source_->description(), turn.mirror ? ", mirrored" : "",
                             turn.quarters == 0 ? "" : fmt::format(", turned by {}°", 90 * turn.quarters));
  return reported(result);
}

FrameResult TurnedSource::wait_frame(TimeNs timeout_ns, FrameView& frame) {
  const FrameResult result = reported(source_->wait_frame(timeout_ns, frame));
  if (result != FrameResult::Frame) return result;
  frame = turner_.of(frame);
  return result;
}

}  // namespace heel
