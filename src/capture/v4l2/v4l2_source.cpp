#include "capture/v4l2/v4l2_source.h"

#include <linux/videodev2.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "realtime/clock.h"

namespace heel {

namespace {

// One being looked at, one being filled, and two so that a late wake-up costs no frame.
constexpr std::uint32_t kBuffers = 4;
constexpr std::uint32_t kFewestBuffers = 2;

v4l2_buffer capture_buffer(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

/// Errors that say the device is not there now, and may be again.
bool is_absence(int error) {
  return error == ENOENT || error == ENODEV || error == ENXIO || error == EIO || error == EBUSY;
}

}  // namespace

TimeNs capture_time_ns(const v4l2_buffer& buffer, TimeNs exposure_ns, TimeNs arrived_ns) {
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) return arrived_ns;
  // A driver's 64-bit nanoseconds may have wrapped: seconds that do not fit back into nanoseconds are no
  // time.
  const std::int64_t stamp_s = buffer.timestamp.tv_sec;
  if (stamp_s < 0 || stamp_s > arrived_ns / kNsPerS) return arrived_ns;
  const TimeNs stamp_ns = stamp_s * kNsPerS + buffer.timestamp.tv_usec * kNsPerUs;
  if (!is_believable_stamp(stamp_ns, arrived_ns)) return arrived_ns;
  // Start-of-exposure stamps lie half an exposure before its middle, end-of-frame stamps (at least) half
  // an exposure after it.
  const bool at_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return at_start ? stamp_ns + exposure_ns / 2 : stamp_ns - exposure_ns / 2;
}

V4l2Source::V4l2Source(const std::string& path, const CameraConfig& config,
                       std::unique_ptr<V4l2Device> device)
    : FrameSource("v4l2:" + path), path_(path), config_(config), device_(std::move(device)) {}

V4l2Source::~V4l2Source() {
  close();
}

OpenResult V4l2Source::open() {
  close();
  OpenResult result = open_device();
  if (result == OpenResult::Opened) result = start_streaming();
  if (result != OpenResult::Opened) close();
  return result;
}

OpenResult V4l2Source::open_device() {
  if (const int error = device_->open(path_); error != 0) {
    const OpenResult result = is_absence(error) ? OpenResult::Absent : OpenResult::Refused;
    if (error == ENOTTY) return fail(result, "is not a device; expected a camera such as /dev/video0");
    return fail(result, std::string("cannot be opened: ") + std::strerror(error));
  }
  agreement_ = agree_with_device(*device_, config_);
  if (!agreement_.agreed) return fail(OpenResult::Refused, agreement_.problem);
  std::array<char, 160> terms{};
  std::snprintf(terms.data(), terms.size(), "%s %ux%u at %.4g Hz", to_string(agreement_.format),
                agreement_.width_px, agreement_.height_px, agreement_.rate_hz);
  description_ = address_ + ": " + agreement_.card + ", " + terms.data();
  if (agreement_.rate_hz < 0.9 * config_.rate_hz || agreement_.rate_hz > 1.1 * config_.rate_hz) {
    std::snprintf(terms.data(), terms.size(), " (asked for %.4g Hz)", config_.rate_hz);
    description_ += terms.data();
  }
  if (!agreement_.controls.empty()) description_ += ", " + agreement_.controls;
  return OpenResult::Opened;
}

OpenResult V4l2Source::start_streaming() {
  const OpenResult mapped = map_buffers();
  if (mapped != OpenResult::Opened) return mapped;
  for (std::uint32_t index = 0; index < buffers_.size(); ++index) {
    if (const int error = queue(index); error != 0) {
      return fail(OpenResult::Absent, std::string("cannot queue a buffer: ") + std::strerror(error));
    }
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (const int error = device_->control(VIDIOC_STREAMON, &type); error != 0) {
    return fail(OpenResult::Absent, std::string("does not start streaming: ") + std::strerror(error));
  }
  streaming_ = true;
  count_.restart();
  heard_ns_ = monotonic_now_ns();
  grey_.assign(std::size_t{agreement_.width_px} * agreement_.height_px, 0);
  return OpenResult::Opened;
}

OpenResult V4l2Source::map_buffers() {
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_->control(VIDIOC_REQBUFS, &request); error != 0) {
    const OpenResult result = is_absence(error) ? OpenResult::Absent : OpenResult::Refused;
    return fail(result, std::string("gives no buffers: ") + std::strerror(error) +
                            (error == EBUSY ? "; another program is using it" : ""));
  }
  if (request.count < kFewestBuffers) {
    return fail(OpenResult::Refused, "gives " + std::to_string(request.count) +
                                         " buffer(s); expected at least " + std::to_string(kFewestBuffers));
  }
  for (std::uint32_t index = 0; index < request.count; ++index) {
    v4l2_buffer buffer = capture_buffer(index);
    const int error = device_->control(VIDIOC_QUERYBUF, &buffer);
    void* memory = error == 0 ? device_->map(buffer.length, buffer.m.offset) : nullptr;
    if (memory == nullptr) return fail(OpenResult::Absent, "its buffers cannot be mapped");
    buffers_.push_back({static_cast<std::uint8_t*>(memory), buffer.length});
  }
  return OpenResult::Opened;
}

int V4l2Source::queue(std::uint32_t index) {
  v4l2_buffer buffer = capture_buffer(index);
  return device_->control(VIDIOC_QBUF, &buffer);
}

FrameResult V4l2Source::wait_frame(TimeNs timeout_ns, FrameView& frame) {
  if (!streaming_) return fail(FrameResult::Lost, "not open");
  if (std::exchange(holding_, false)) {
    if (const int error = queue(held_); error != 0) return lose("takes no buffer back", error);
  }
  const PollResult ready = device_->wait_readable(timeout_ns);
  if (ready == PollResult::Failed) return lose("cannot be waited for", ENODEV);
  v4l2_buffer buffer = capture_buffer(0);
  const int error = ready == PollResult::Ready ? device_->control(VIDIOC_DQBUF, &buffer) : EAGAIN;
  const TimeNs now_ns = monotonic_now_ns();
  if (error == EAGAIN) {
    return now_ns - heard_ns_ > kStall_ns ? fail(FrameResult::Lost, "no frame for 2 s")
                                          : FrameResult::Timeout;
  }
  if (error != 0) return lose("gives no frame", error);
  if (buffer.index >= buffers_.size()) return lose("gives a buffer it was not given", EINVAL);
  heard_ns_ = now_ns;
  holding_ = true;
  held_ = buffer.index;
  count_.advance(buffer.sequence);
  counters_.dropped_by_driver += count_.gap();
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) {
    ++counters_.dropped_by_driver;
    return fail(FrameResult::Error, "a frame the driver marked as damaged");
  }
  frame.header = {.sequence = count_.sequence(),
                  .t_capture_ns = capture_time_ns(buffer, ns_from_seconds(agreement_.exposure_s), now_ns),
                  .width_px = agreement_.width_px,
                  .height_px = agreement_.height_px};
  return deliver(buffer, frame);
}

FrameResult V4l2Source::deliver(const v4l2_buffer& buffer, FrameView& frame) {
  const Buffer& memory = buffers_[buffer.index];
  const std::uint32_t width_px = agreement_.width_px;
  const std::uint32_t height_px = agreement_.height_px;
  const std::size_t needed =
      luma_bytes_needed(agreement_.format, width_px, height_px, agreement_.stride_bytes);
  if (buffer.bytesused > memory.bytes || buffer.bytesused == 0 || buffer.bytesused < needed) {
    return refuse("a frame that is too short");
  }
  Luma luma{grey_.data(), width_px};
  if (agreement_.format != PixelFormat::Mjpg) {
    luma =
        luma_of(agreement_.format, memory.data, agreement_.stride_bytes, width_px, height_px, grey_.data());
  } else if (!jpeg_.decode(memory.data, buffer.bytesused, width_px, height_px, grey_.data())) {
    return refuse(jpeg_.problem());
  }
  frame.grey = luma.first;
  frame.stride_bytes = luma.stride_bytes;
  return FrameResult::Frame;
}

FrameResult V4l2Source::lose(const char* what, int error) {
  return fail(FrameResult::Lost, std::string(what) + ": " + std::strerror(error));
}

FrameResult V4l2Source::refuse(const char* what) {
  ++counters_.corrupt;
  return fail(FrameResult::Error, what);
}

void V4l2Source::close() {
  if (streaming_) {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    device_->control(VIDIOC_STREAMOFF, &type);
  }
  streaming_ = false;
  holding_ = false;
  for (const Buffer& buffer : buffers_) device_->unmap(buffer.data, buffer.bytes);
  buffers_.clear();
  device_->close();
}

}  // namespace heel
