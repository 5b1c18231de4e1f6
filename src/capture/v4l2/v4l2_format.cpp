#include "capture/v4l2/v4l2_format.h"

#include <linux/videodev2.h>

#include <cmath>
#include <cstring>
#include <vector>

namespace heel {

namespace {

// A device that says 29.97 for 30 does what was asked.
constexpr double kRateTolerance = 0.02;

std::uint32_t fourcc_of(PixelFormat format) {
  switch (format) {
    case PixelFormat::Grey:
      return V4L2_PIX_FMT_GREY;
    case PixelFormat::Nv12:
      return V4L2_PIX_FMT_NV12;
    case PixelFormat::Yuyv:
      return V4L2_PIX_FMT_YUYV;
    case PixelFormat::Rgb3:
      return V4L2_PIX_FMT_RGB24;
    case PixelFormat::Bgr3:
      return V4L2_PIX_FMT_BGR24;
    case PixelFormat::Mjpg:
      return V4L2_PIX_FMT_MJPEG;
  }
  return 0;
}

std::string fourcc_text(std::uint32_t fourcc) {
  std::string text;
  for (unsigned shift = 0; shift < 32; shift += 8) {
    const char c = static_cast<char>((fourcc >> shift) & 0x7f);
    text += c >= ' ' ? c : '?';
  }
  return text;
}

std::string size_text(std::uint32_t width_px, std::uint32_t height_px) {
  return std::to_string(width_px) + "x" + std::to_string(height_px);
}

std::vector<std::uint32_t> offered_formats(V4l2Device& device) {
  std::vector<std::uint32_t> offered;
  v4l2_fmtdesc description{};
  description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  // The bound is for a driver that never says it has named them all.
  while (description.index < 64 && device.control(VIDIOC_ENUM_FMT, &description) == 0) {
    offered.push_back(description.pixelformat);
    ++description.index;
  }
  return offered;
}

bool is_offered(const std::vector<std::uint32_t>& offered, PixelFormat format) {
  for (const std::uint32_t fourcc : offered) {
    if (fourcc == fourcc_of(format)) return true;
  }
  return false;
}

/// S_FMT, and whether the device took exactly what was asked.
bool set_format(V4l2Device& device, const CameraConfig& config, PixelFormat wanted,
                V4l2Agreement& agreement) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(config.width_px);
  format.fmt.pix.height = static_cast<std::uint32_t>(config.height_px);
  format.fmt.pix.pixelformat = fourcc_of(wanted);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  const std::string asked = size_text(format.fmt.pix.width, format.fmt.pix.height) + " " + to_string(wanted);
  const int error = device.control(VIDIOC_S_FMT, &format);
  if (error != 0) {
    agreement.problem = "cannot set " + asked + ": " + std::strerror(error);
    return false;
  }
  const v4l2_pix_format& given = format.fmt.pix;
  const bool as_asked = given.width == static_cast<std::uint32_t>(config.width_px) &&
                        given.height == static_cast<std::uint32_t>(config.height_px) &&
                        given.pixelformat == fourcc_of(wanted);
  if (!as_asked) {
    agreement.problem = "asked for " + asked + ", the device gives " + size_text(given.width, given.height) +
                        " " + fourcc_text(given.pixelformat) +
                        "; expected camera.width_px, height_px and format it has";
    return false;
  }
  if (given.field != V4L2_FIELD_NONE && given.field != V4L2_FIELD_ANY) {
    agreement.problem = "gives interlaced pictures at " + asked + "; expected a progressive camera";
    return false;
  }
  agreement.format = wanted;
  agreement.width_px = given.width;
  agreement.height_px = given.height;
  const std::uint32_t least = row_bytes(wanted, given.width);
  // Old drivers leave bytesperline 0 when rows are not padded.
  agreement.stride_bytes = given.bytesperline == 0 ? least : given.bytesperline;
  if (wanted == PixelFormat::Mjpg) agreement.stride_bytes = 0;
  if (agreement.stride_bytes < least) {
    agreement.problem = "says a row of " + asked + " has " + std::to_string(given.bytesperline) +
                        " bytes; expected at least " + std::to_string(least);
    return false;
  }
  return true;
}

double rate_of(const v4l2_streamparm& parameters) {
  const v4l2_fract& interval = parameters.parm.capture.timeperframe;
  return interval.numerator == 0 ? 0.0 : static_cast<double>(interval.denominator) / interval.numerator;
}

/// S_PARM and what G_PARM says then. Devices without a settable rate keep their own.
double set_rate(V4l2Device& device, double rate_hz) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  if (device.control(VIDIOC_G_PARM, &parameters) != 0) return 0.0;
  if ((parameters.parm.capture.capability & V4L2_CAP_TIMEPERFRAME) == 0) return rate_of(parameters);
  parameters = {};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  parameters.parm.capture.timeperframe = {1000, static_cast<std::uint32_t>(std::lround(rate_hz * 1000.0))};
  device.control(VIDIOC_S_PARM, &parameters);
  parameters = {};
  parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  return device.control(VIDIOC_G_PARM, &parameters) == 0 ? rate_of(parameters) : 0.0;
}

/// Format, then rate: setting a format resets the rate.
bool try_format(V4l2Device& device, const CameraConfig& config, PixelFormat wanted,
                V4l2Agreement& agreement) {
  if (!set_format(device, config, wanted, agreement)) return false;
  agreement.rate_hz = set_rate(device, config.rate_hz);
  return true;
}

}  // namespace

void agree_on_format(V4l2Device& device, const CameraConfig& config, V4l2Agreement& agreement) {
  const std::vector<std::uint32_t> offered = offered_formats(device);
  PixelFormat asked = PixelFormat::Grey;
  if (parse_pixel_format(config.format, asked)) {
    agreement.agreed = try_format(device, config, asked, agreement);
    return;
  }
  bool any = false;
  PixelFormat fastest = PixelFormat::Grey;
  double fastest_hz = -1.0;
  for (const PixelFormat candidate : pixel_formats()) {
    if (!is_offered(offered, candidate)) continue;
    any = true;
    if (!try_format(device, config, candidate, agreement)) continue;
    if (agreement.rate_hz >= config.rate_hz * (1.0 - kRateTolerance)) {
      agreement.agreed = true;
      return;
    }
    if (agreement.rate_hz > fastest_hz) {
      fastest = candidate;
      fastest_hz = agreement.rate_hz;
    }
  }
  if (!any) {
    std::string names;
    for (const std::uint32_t fourcc : offered) names += (names.empty() ? "" : ", ") + fourcc_text(fourcc);
    agreement.problem = "offers " + (names.empty() ? "no format" : names) +
                        "; expected one of GREY, NV12, YUYV, RGB3, BGR3, MJPG";
    return;
  }
  if (fastest_hz >= 0.0) agreement.agreed = try_format(device, config, fastest, agreement);
}

}  // namespace heel
