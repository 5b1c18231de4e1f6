#include "capture/v4l2/v4l2_source.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "capture/v4l2/device_users.h"
#include "realtime/clock.h"

namespace heel {

namespace {

// One is in use, one is being filled, and two more so that a late wake-up loses no frame.
constexpr std::uint32_t kBuffers = 4;
constexpr std::uint32_t kMinBuffers = 2;

v4l2_buffer capture_buffer(std::uint32_t index) {
  v4l2_buffer buffer{};
  buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  buffer.memory = V4L2_MEMORY_MMAP;
  buffer.index = index;
  return buffer;
}

/// True for errors that mean: the device is not there now, but may be later.
bool means_device_absent(int error) {
  return error == ENOENT || error == ENODEV || error == ENXIO || error == EIO || error == EBUSY;
}

}  // namespace

TimeNs capture_time_ns(const v4l2_buffer& buffer, TimeNs exposure_ns, TimeNs arrived_ns) {
  if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) != V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) return arrived_ns;
  // A driver's 64-bit nanoseconds may have wrapped; its seconds then do not fit into nanoseconds.
  const std::int64_t stamp_s = buffer.timestamp.tv_sec;
  if (stamp_s < 0 || stamp_s > arrived_ns / kNsPerS) return arrived_ns;
  const TimeNs stamp_ns = stamp_s * kNsPerS + buffer.timestamp.tv_usec * kNsPerUs;
  if (!is_plausible_stamp(stamp_ns, arrived_ns)) return arrived_ns;
  // A stamp of the start of exposure lies half an exposure before its middle; a stamp of the end of the frame
  // lies at least half an exposure after it.
  const bool at_start = (buffer.flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  return at_start ? stamp_ns + exposure_ns / 2 : stamp_ns - exposure_ns / 2;
}

V4l2Source::V4l2Source(const std::string& path, const CameraConfig& config,
                       std::unique_ptr<V4l2Device> device)
    : FrameSource("v4l2:" + path), path_(path), config_(config), device_(std::move(device)) {}

V4l2Source::~V4l2Source() {
  close();
}

/// Formats for which the USB bus has no bandwidth are left out, one after the other, when the format is free.
OpenResult V4l2Source::open() {
  std::vector<PixelFormat> without;
  for (;;) {
    close();
    OpenResult result = open_device(without);
    if (result == OpenResult::Opened) result = start_streaming();
    if (result == OpenResult::Opened) return result;
    if (no_bandwidth_) without.push_back(setup_.format);
    PixelFormat named = PixelFormat::Grey;
    if (no_bandwidth_ && !parse_pixel_format(config_.format, named)) continue;
    close();
    return no_bandwidth_ || setup_.none_left ? fail_without_bandwidth(without) : result;
  }
}

OpenResult V4l2Source::fail_without_bandwidth(const std::vector<PixelFormat>& tried) {
  std::string names;
  for (const PixelFormat format : tried)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", to_string(format));
  return fail(
      OpenResult::Absent,
      fmt::format("does not start streaming: too little USB bandwidth for {}x{} at {:g} Hz as {} (expected "
                  "fewer cameras on this USB controller, camera.format = \"MJPG\", a smaller picture or a "
                  "lower rate)",
                  config_.width_px, config_.height_px, config_.rate_hz, names));
}

std::string V4l2Source::in_use_by() const {
  const std::string programs = programs_holding(path_);
  return programs.empty() ? "; another program is using it" : "; in use by " + programs;
}

OpenResult V4l2Source::open_device(const std::vector<PixelFormat>& without) {
  no_bandwidth_ = false;
  setup_ = {};
  if (const int error = device_->open(path_); error != 0) {
    const OpenResult result = means_device_absent(error) ? OpenResult::Absent : OpenResult::Refused;
    if (error == ENOTTY) return fail(result, "is not a device (expected a camera such as /dev/video0)");
    std::string hint;
    if (error == EACCES || error == EPERM)
      hint = " (expected a user of the group video: sudo usermod -aG video USER, then log in again)";
    if (error == EBUSY) hint = in_use_by();
    return fail(result, fmt::format("cannot be opened: {}{}", std::strerror(error), hint));
  }
  setup_ = set_up_device(*device_, config_, without);
  if (setup_.busy) return fail(OpenResult::Absent, setup_.problem + in_use_by());
  if (!setup_.complete) return fail(OpenResult::Refused, setup_.problem);
  description_ = fmt::format("{}: {}, {} {}x{} at {:.4g} Hz", address_, setup_.card, to_string(setup_.format),
                             setup_.width_px, setup_.height_px, setup_.rate_hz);
  if (setup_.rate_hz < 0.9 * config_.rate_hz || setup_.rate_hz > 1.1 * config_.rate_hz) {
    description_ += fmt::format(" (requested: {:.4g} Hz)", config_.rate_hz);
  }
  if (setup_.interlaced) description_ += ", interlaced: every second row is used";
  if (!setup_.controls.empty()) description_ += ", " + setup_.controls;
  return OpenResult::Opened;
}

OpenResult V4l2Source::start_streaming() {
  const OpenResult mapped = map_buffers();
  if (mapped != OpenResult::Opened) return mapped;
  for (std::uint32_t index = 0; index < buffers_.size(); ++index) {
    if (const int error = queue(index); error != 0) {
      return fail(OpenResult::Absent, fmt::format("cannot queue a buffer: {}", std::strerror(error)));
    }
  }
  int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (const int error = device_->control(VIDIOC_STREAMON, &type); error != 0) {
    no_bandwidth_ = error == ENOSPC;
    return fail(OpenResult::Absent, fmt::format("does not start streaming: {}{}", std::strerror(error),
                                                error == EBUSY ? in_use_by() : ""));
  }
  streaming_ = true;
  sequence_.restart();
  stall_.opened(monotonic_now_ns());
  converter_.configure(setup_.format, setup_.width_px, setup_.height_px, setup_.stride_bytes,
                       setup_.interlaced);
  return OpenResult::Opened;
}

OpenResult V4l2Source::map_buffers() {
  v4l2_requestbuffers request{};
  request.count = kBuffers;
  request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  request.memory = V4L2_MEMORY_MMAP;
  if (const int error = device_->control(VIDIOC_REQBUFS, &request); error != 0) {
    const OpenResult result = means_device_absent(error) ? OpenResult::Absent : OpenResult::Refused;
    return fail(result, fmt::format("gives no buffers: {}{}", std::strerror(error),
                                    error == EBUSY ? in_use_by() : ""));
  }
  if (request.count < kMinBuffers) {
    return fail(OpenResult::Refused,
                fmt::format("gives {} buffer(s) (expected at least {})", request.count, kMinBuffers));
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
  if (!streaming_) return fail(FrameResult::Lost, "is not open");
  if (std::exchange(holding_, false)) {
    if (const int error = queue(held_); error != 0) return fail_lost("takes no buffer back", error);
  }
  const PollResult ready = device_->wait_readable(timeout_ns);
  if (ready == PollResult::Failed) return fail_lost("waiting for a frame failed", ENODEV);
  v4l2_buffer buffer = capture_buffer(0);
  const int error = ready == PollResult::Ready ? device_->control(VIDIOC_DQBUF, &buffer) : EAGAIN;
  const TimeNs now_ns = monotonic_now_ns();
  if (error == EAGAIN) {
    if (!stall_.stalled(now_ns)) return FrameResult::Timeout;
    return fail(FrameResult::Lost, fmt::format("no frame for {} s", stall_.allowed_ns() / kNsPerS));
  }
  if (error != 0) return fail_lost("gives no frame", error);
  if (buffer.index >= buffers_.size()) return fail_lost("gives a buffer that it does not have", EINVAL);
  stall_.frame(now_ns);
  holding_ = true;
  held_ = buffer.index;
  sequence_.advance(buffer.sequence);
  counters_.dropped_by_driver += sequence_.gap();
  if ((buffer.flags & V4L2_BUF_FLAG_ERROR) != 0) {
    ++counters_.dropped_by_driver;
    return fail(FrameResult::Error, kDamagedText);
  }
  frame.header = {.sequence = sequence_.sequence(),
                  .t_capture_ns = capture_time_ns(buffer, ns_from_seconds(setup_.exposure_s), now_ns),
                  .width_px = setup_.width_px,
                  .height_px = setup_.height_px};
  return deliver(buffer, frame);
}

FrameResult V4l2Source::deliver(const v4l2_buffer& buffer, FrameView& frame) {
  const Buffer& memory = buffers_[buffer.index];
  if (converter_.convert(memory.data, buffer.bytesused, memory.bytes, frame)) return FrameResult::Frame;
  ++counters_.corrupt;
  return fail(FrameResult::Error, converter_.problem());
}

FrameResult V4l2Source::fail_lost(const char* what, int error) {
  return fail(FrameResult::Lost, fmt::format("{}: {}", what, std::strerror(error)));
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
