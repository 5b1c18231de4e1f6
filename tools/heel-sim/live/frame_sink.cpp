#include "heel-sim/live/frame_sink.h"

#include <cstring>

#include "capture/frame_source.h"
#include "capture/sim_channel.h"
#include "heel-sim/live/v4l2_sink.h"
#include "heel/error.h"

namespace heel::sim {
namespace {

class ChannelSink : public FrameSink {
 public:
  ChannelSink(const std::string& name, int width_px, int height_px)
      : channel_(name, static_cast<std::uint32_t>(width_px), static_cast<std::uint32_t>(height_px)) {}

  void put(const FrameHeader& header, const std::vector<std::uint8_t>& grey) override {
    const WritableFrame out = channel_.writable();
    *out.header = header;
    for (std::size_t y = 0; y < header.height_px; ++y)
      std::memcpy(out.grey + y * out.stride_bytes, grey.data() + y * header.width_px, header.width_px);
    channel_.publish();
  }

 private:
  SimChannelWriter channel_;
};

}  // namespace

std::unique_ptr<FrameSink> open_frame_sink(const std::string& address, int width_px, int height_px,
                                           double rate_hz) {
  const SourceAddress parsed = parse_source_address(address);
  if (parsed.kind == SourceKind::Sim) return std::make_unique<ChannelSink>(parsed.rest, width_px, height_px);
  if (parsed.kind == SourceKind::V4l2)
    return std::make_unique<V4l2Sink>(make_kernel_output_device(), parsed.rest, width_px, height_px, rate_hz);
  throw Error("--camera " + address + " (expected sim:NAME, v4l2:/dev/videoN or none)");
}

}  // namespace heel::sim
