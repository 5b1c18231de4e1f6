#include "sim/live/v4l2_sink.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <cerrno>
#include <cmath>
#include <cstring>

#include "heel/error.h"

namespace heel::sim {
namespace {

constexpr const char* kExpectedDevice =
    "a v4l2loopback device: sudo modprobe v4l2loopback, then one of v4l2-ctl --list-devices";
constexpr std::uint8_t kNoColour = 128;

}  // namespace

V4l2Sink::V4l2Sink(std::unique_ptr<OutputDevice> device, const std::string& path, int width_px, int height_px,
                   double rate_hz)
    : device_(std::move(device)), path_(path) {
  if (const int error = device_->open(path_); error != 0) fail(std::strerror(error), kExpectedDevice);
  check_device();
  set_format(width_px, height_px);
  set_rate(rate_hz);
  yuyv_.assign(2 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), kNoColour);
}

void V4l2Sink::fail(const std::string& found, const std::string& expected) const {
  throw Error(fmt::format("--camera v4l2:{}: {} (expected {})", path_, found, expected));
}

void V4l2Sink::check_device() {
  v4l2_capability capability{};
  if (device_->control(VIDIOC_QUERYCAP, &capability) != 0) fail("not a video device", kExpectedDevice);
  const std::uint32_t supported = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                      ? capability.device_caps
                                      : capability.capabilities;
  const std::string card(reinterpret_cast<const char*>(capability.card),
                         strnlen(reinterpret_cast<const char*>(capability.card), sizeof capability.card));
  if ((supported & V4L2_CAP_VIDEO_OUTPUT) == 0 || (supported & V4L2_CAP_READWRITE) == 0)
    fail(fmt::format("'{}' takes no frames", card), kExpectedDevice);
}

void V4l2Sink::set_format(int width_px, int height_px) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  v4l2_pix_format& pixels = format.fmt.pix;
  pixels.width = static_cast<std::uint32_t>(width_px);
  pixels.height = static_cast<std::uint32_t>(height_px);
  pixels.pixelformat = V4L2_PIX_FMT_YUYV;
  pixels.field = V4L2_FIELD_NONE;
  pixels.bytesperline = 2 * pixels.width;
  pixels.sizeimage = pixels.bytesperline * pixels.height;
  pixels.colorspace = V4L2_COLORSPACE_SRGB;
  const std::string wanted = fmt::format("{} x {} YUYV", width_px, height_px);
  const int error = device_->control(VIDIOC_S_FMT, &format);
  if (error == EBUSY) fail("in use with another format", "no other program that writes to it, or " + wanted);
  if (error != 0) fail(std::string("no format: ") + std::strerror(error), wanted);
  if (pixels.width != static_cast<std::uint32_t>(width_px) ||
      pixels.height != static_cast<std::uint32_t>(height_px) || pixels.pixelformat != V4L2_PIX_FMT_YUYV ||
      pixels.bytesperline != 2 * pixels.width)
    fail(fmt::format("gives {} x {} instead", pixels.width, pixels.height), "a device that takes " + wanted);
}

/// The rate is information for readers; a device that has none works as well.
void V4l2Sink::set_rate(double rate_hz) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  parameters.parm.output.timeperframe.numerator = 1000;
  parameters.parm.output.timeperframe.denominator = static_cast<std::uint32_t>(std::lround(1000.0 * rate_hz));
  device_->control(VIDIOC_S_PARM, &parameters);
}

void V4l2Sink::put(const FrameView& frame) {
  const std::size_t pixels = std::size_t{frame.header.width_px} * frame.header.height_px;
  for (std::size_t i = 0; i < pixels; ++i) yuyv_[2 * i] = frame.grey[i];
  const std::ptrdiff_t taken = device_->write(yuyv_.data(), yuyv_.size());
  if (taken == -EAGAIN) return;  // no reader has taken the last frame: this one is lost
  if (taken < 0)
    fail(fmt::format("{} while writing", std::strerror(static_cast<int>(-taken))), "the device to stay");
  if (static_cast<std::size_t>(taken) != yuyv_.size())
    fail(fmt::format("took {} of {} bytes", taken, yuyv_.size()), "whole frames to be taken");
}

}  // namespace heel::sim
