// A camera over V4L2: streaming I/O with memory-mapped buffers. One buffer is held while its frame is in use;
// GREY and NV12 are not copied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "capture/driver_sequence.h"
#include "capture/frame_source.h"
#include "capture/luma_converter.h"
#include "capture/stall_watch.h"
#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_setup.h"

struct v4l2_buffer;

namespace heel {

/// The middle of the exposure, by the buffer's flags and time stamp and a fixed exposure time. A stamp that
/// is not of CLOCK_MONOTONIC, or not plausible (in the future, or older than a second), is replaced by the
/// time of arrival.
TimeNs capture_time_ns(const v4l2_buffer& buffer, TimeNs exposure_ns, TimeNs arrived_ns);

class V4l2Source final : public FrameSource {
 public:
  V4l2Source(const std::string& path, const CameraConfig& config,
             std::unique_ptr<V4l2Device> device = make_kernel_v4l2_device());
  ~V4l2Source() override;

  OpenResult open() override;
  FrameResult wait_frame(TimeNs timeout_ns, FrameView& frame) override;
  void close() override;

 private:
  struct Buffer {
    std::uint8_t* data = nullptr;
    std::size_t bytes = 0;
  };

  OpenResult open_device(const std::vector<PixelFormat>& without);
  OpenResult fail_without_bandwidth(const std::vector<PixelFormat>& tried);
  std::string in_use_by() const;
  OpenResult start_streaming();
  OpenResult map_buffers();
  int queue(std::uint32_t index);
  FrameResult fail_lost(const char* what, int error);
  FrameResult deliver(const v4l2_buffer& buffer, FrameView& frame);

  std::string path_;
  CameraConfig config_;
  std::unique_ptr<V4l2Device> device_;
  V4l2Setup setup_;
  std::vector<Buffer> buffers_;
  LumaConverter converter_;
  bool no_bandwidth_ = false;  ///< the last start of streaming failed for lack of USB bandwidth
  bool streaming_ = false;
  bool holding_ = false;  ///< buffer `held_` is in use until the next call
  std::uint32_t held_ = 0;
  StallWatch stall_;
  DriverSequence sequence_;
};

}  // namespace heel
