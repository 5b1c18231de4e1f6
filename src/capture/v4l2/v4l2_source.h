// A camera over V4L2: streaming I/O with memory-mapped buffers. One buffer at a time is held while its frame
// is looked at; GREY and NV12 are looked at in place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "capture/driver_count.h"
#include "capture/frame_source.h"
#include "capture/jpeg_decoder.h"
#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_setup.h"

struct v4l2_buffer;

namespace heel {

/// When the middle of the exposure was, as near as buffer flags, time stamp and a fixed exposure tell. A
/// stamp that is not of CLOCK_MONOTONIC, or cannot be true (in the future, or older than a second), is
/// replaced by the time of arrival.
TimeNs capture_time_ns(const v4l2_buffer& buffer, TimeNs exposure_ns, TimeNs arrived_ns);

class V4l2Source final : public FrameSource {
 public:
  V4l2Source(const std::string& path, const CameraConfig& config,
             std::unique_ptr<V4l2Device> device = make_kernel_v4l2_device());
  ~V4l2Source() override;

  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override;

  /// No frame for this long: the device has stalled, and only opening it again may help.
  static constexpr TimeNs kStall_ns = 2 * kNsPerS;

 private:
  struct Buffer {
    std::uint8_t* data = nullptr;
    std::size_t bytes = 0;
  };

  OpenResult open_device();
  OpenResult start_streaming();
  OpenResult map_buffers();
  int queue(std::uint32_t index);
  FrameResult lose(const char* what, int error);
  FrameResult refuse(const char* what);
  FrameResult deliver(const v4l2_buffer& buffer, FrameView& frame);

  std::string path_;
  CameraConfig config_;
  std::unique_ptr<V4l2Device> device_;
  V4l2Agreement agreement_;
  JpegDecoder jpeg_;
  std::vector<Buffer> buffers_;
  std::vector<std::uint8_t> grey_;  ///< of formats that are not grey already
  bool streaming_ = false;
  bool holding_ = false;  ///< buffer `held_` is ours until the next call
  std::uint32_t held_ = 0;
  TimeNs heard_ns_ = 0;  ///< when the device last gave a buffer
  DriverCount count_;
};

}  // namespace heel
