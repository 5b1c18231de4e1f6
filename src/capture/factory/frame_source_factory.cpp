#include "capture/factory/frame_source_factory.h"

#include "capture/factory/camera_module.h"
#include "capture/factory/source_address.h"
#include "capture/shared_memory/sim_source.h"
#include "capture/turned/turned_source.h"
#include "capture/v4l2/v4l2_source.h"
#include "core/picture_turn.h"
#include "heel/error.h"

namespace heel {

namespace {

std::unique_ptr<FrameSource> make_untouched(const CameraConfig& config) {
  const SourceAddress address = parse_source_address(config.source);
  switch (address.kind) {
    case SourceKind::File:
      return source_of_module("file", address.rest, config);
    case SourceKind::Sim:
      return std::make_unique<SimSource>(address.rest);
    case SourceKind::V4l2:
      return std::make_unique<V4l2Source>(address.rest, config);
    case SourceKind::Libcamera:
      break;
  }
#ifdef HEEL_HAVE_LIBCAMERA
  return source_of_module("libcamera", address.rest, config);
#else
  throw Error("camera address '" + config.source +
              "': this program was built without libcamera (expected v4l2:PATH, file:PATH or sim:NAME)");
#endif
}

}  // namespace

std::unique_ptr<FrameSource> make_frame_source(const CameraConfig& config) {
  std::unique_ptr<FrameSource> source = make_untouched(config);
  const PictureTurn turn = picture_turn(config.rotate, config.mirror);
  if (!turn.any()) return source;
  return std::make_unique<TurnedSource>(std::move(source), turn, static_cast<std::uint32_t>(config.width_px),
                                        static_cast<std::uint32_t>(config.height_px));
}

std::unique_ptr<FrameSource> open_frame_source(const CameraConfig& config) {
  std::unique_ptr<FrameSource> source = make_frame_source(config);
  if (source->open() != OpenResult::Opened) throw Error(source->problem());
  return source;
}

}  // namespace heel
