#include "sim/live/frame_sink.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "capture/factory/source_address.h"
#include "capture/frame_source.h"
#include "capture/shared_memory/sim_channel.h"
#include "files/image_file.h"
#include "heel/error.h"
#include "sim/live/v4l2_sink.h"

namespace heel::sim {
namespace {

class ChannelSink : public FrameSink {
 public:
  ChannelSink(const std::string& name, int width_px, int height_px)
      : channel_(name, static_cast<std::uint32_t>(width_px), static_cast<std::uint32_t>(height_px)) {}

  void put(const FrameView& frame) override {
    const FrameHeader& header = frame.header;
    const WritableFrame out = channel_.writable();
    *out.header = header;
    for (std::size_t y = 0; y < header.height_px; ++y)
      std::memcpy(out.grey + y * out.stride_bytes, frame.grey + y * header.width_px, header.width_px);
    channel_.publish();
  }

 private:
  SimChannelWriter channel_;
};

/// A picture file that every frame replaces. The frame is written beside it and renamed, so that readers only
/// see whole pictures.
class PictureSink : public FrameSink {
 public:
  explicit PictureSink(std::string path) : path_(std::move(path)), temporary_path_(path_ + ".part.pgm") {
    if (!path_.ends_with(".pgm")) throw Error("--camera file:" + path_ + " (expected file:PICTURE.pgm)");
  }

  void put(const FrameView& frame) override {
    write_grey_image(temporary_path_, frame.grey, static_cast<int>(frame.header.width_px),
                     static_cast<int>(frame.header.height_px));
    if (std::rename(temporary_path_.c_str(), path_.c_str()) != 0)
      throw Error(path_ + ": cannot be replaced: " + std::strerror(errno));
  }

 private:
  std::string path_, temporary_path_;
};

}  // namespace

std::unique_ptr<FrameSink> open_frame_sink(const std::string& address, int width_px, int height_px,
                                           double rate_hz) {
  const SourceAddress parsed = parse_source_address(address);
  if (parsed.kind == SourceKind::Sim) return std::make_unique<ChannelSink>(parsed.rest, width_px, height_px);
  if (parsed.kind == SourceKind::V4l2)
    return std::make_unique<V4l2Sink>(make_kernel_output_device(), parsed.rest, width_px, height_px, rate_hz);
  if (parsed.kind == SourceKind::File) return std::make_unique<PictureSink>(parsed.rest);
  throw Error("--camera " + address + " (expected sim:NAME, v4l2:/dev/videoN, file:PICTURE.pgm or none)");
}

}  // namespace heel::sim
