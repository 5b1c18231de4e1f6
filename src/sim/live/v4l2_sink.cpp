#include "sim/live/v4l2_sink.h"

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
  if (const int error = device_->open(path_); error != 0) refuse(std::strerror(error), kExpectedDevice);
  check_device();
  set_format(width_px, height_px);
  set_rate(rate_hz);
  yuyv_.assign(2 * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), kNoColour);
}

void V4l2Sink::refuse(const std::string& found, const std::string& expected) const {
  throw Error("--camera v4l2:" + path_ + ": " + found + " (expected " + expected + ")");
}

void V4l2Sink::check_device() {
  v4l2_capability capability{};
  if (device_->control(VIDIOC_QUERYCAP, &capability) != 0) refuse("not a video device", kExpectedDevice);
  const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? capability.device_caps
                                                                                  : capability.capabilities;
  const std::string card(reinterpret_cast<const char*>(capability.card),
                         strnlen(reinterpret_cast<const char*>(capability.card), sizeof capability.card));
  if ((can & V4L2_CAP_VIDEO_OUTPUT) == 0 || (can & V4L2_CAP_READWRITE) == 0)
    refuse("'" + card + "' takes no frames", kExpectedDevice);
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
  const std::string wanted = std::to_string(width_px) + " x " + std::to_string(height_px) + " YUYV";
  const int error = device_->control(VIDIOC_S_FMT, &format);
  if (error == EBUSY) refuse("in use with another format", "nobody else writing to it, or " + wanted);
  if (error != 0) refuse(std::string("no format: ") + std::strerror(error), wanted);
  if (pixels.width != static_cast<std::uint32_t>(width_px) ||
      pixels.height != static_cast<std::uint32_t>(height_px) || pixels.pixelformat != V4L2_PIX_FMT_YUYV ||
      pixels.bytesperline != 2 * pixels.width)
    refuse("gives " + std::to_string(pixels.width) + " x " + std::to_string(pixels.height) + " instead",
           "a device that takes " + wanted);
}

/// For readers that ask; a device without a rate works as well.
void V4l2Sink::set_rate(double rate_hz) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  parameters.parm.output.timeperframe.numerator = 1000;
  parameters.parm.output.timeperframe.denominator = static_cast<std::uint32_t>(std::lround(1000.0 * rate_hz));
  device_->control(VIDIOC_S_PARM, &parameters);
}

void V4l2Sink::put(const FrameHeader& /*header*/, const std::vector<std::uint8_t>& grey) {
  for (std::size_t i = 0; i < grey.size(); ++i) yuyv_[2 * i] = grey[i];
  const std::ptrdiff_t taken = device_->write(yuyv_.data(), yuyv_.size());
  if (taken == -EAGAIN) return;  // nobody has read the last one: this one is lost
  if (taken < 0)
    refuse(std::strerror(static_cast<int>(-taken)) + std::string(" while writing"), "the device to stay");
  if (static_cast<std::size_t>(taken) != yuyv_.size())
    refuse("took " + std::to_string(taken) + " of " + std::to_string(yuyv_.size()) + " bytes",
           "whole frames to be taken");
}

}  // namespace heel::sim
