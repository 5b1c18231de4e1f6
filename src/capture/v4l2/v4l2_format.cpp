#include "capture/v4l2/v4l2_format.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <vector>

namespace heel {

namespace {

// 29.97 Hz instead of 30 Hz is the requested rate.
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

std::vector<std::uint32_t> offered_formats(V4l2Device& device) {
  std::vector<std::uint32_t> offered;
  v4l2_fmtdesc description{};
  description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  // The bound is for a driver whose list does not end.
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

/// The rows of two fields in turn; the analogue cameras of a frame grabber.
bool is_interlaced(std::uint32_t field) {
  return field == V4L2_FIELD_INTERLACED || field == V4L2_FIELD_INTERLACED_TB ||
         field == V4L2_FIELD_INTERLACED_BT;
}

/// S_FMT. True: the device has set exactly what was requested.
bool set_format(V4l2Device& device, const CameraConfig& config, PixelFormat wanted, V4l2Setup& setup) {
  setup.busy = false;
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = static_cast<std::uint32_t>(config.width_px);
  format.fmt.pix.height = static_cast<std::uint32_t>(config.height_px);
  format.fmt.pix.pixelformat = fourcc_of(wanted);
  format.fmt.pix.field = V4L2_FIELD_NONE;
  const std::string requested =
      fmt::format("{}x{} {}", format.fmt.pix.width, format.fmt.pix.height, to_string(wanted));
  const int error = device.control(VIDIOC_S_FMT, &format);
  if (error != 0) {
    setup.busy = error == EBUSY;
    setup.problem = fmt::format("cannot set {}: {}", requested, std::strerror(error));
    return false;
  }
  const v4l2_pix_format& given = format.fmt.pix;
  const bool as_requested = given.width == static_cast<std::uint32_t>(config.width_px) &&
                            given.height == static_cast<std::uint32_t>(config.height_px) &&
                            given.pixelformat == fourcc_of(wanted);
  if (!as_requested) {
    setup.problem = fmt::format(
        "requested {}, the device gives {}x{} {} (expected camera.width_px, height_px and format that it "
        "has)",
        requested, given.width, given.height, fourcc_text(given.pixelformat));
    return false;
  }
  setup.interlaced = is_interlaced(given.field);
  if (!setup.interlaced && given.field != V4L2_FIELD_NONE && given.field != V4L2_FIELD_ANY) {
    setup.problem = fmt::format(
        "gives single or separate fields at {} (expected whole frames, progressive or interlaced)",
        requested);
    return false;
  }
  setup.format = wanted;
  setup.width_px = given.width;
  setup.height_px = given.height;
  const std::uint32_t least = row_bytes(wanted, given.width);
  // Old drivers set bytesperline to 0 when rows are not padded.
  setup.stride_bytes = given.bytesperline == 0 ? least : given.bytesperline;
  if (wanted == PixelFormat::Mjpg) setup.stride_bytes = 0;
  if (setup.stride_bytes < least) {
    setup.problem = fmt::format("gives {} bytes for a row of {} (expected at least {})", given.bytesperline,
                                requested, least);
    return false;
  }
  return true;
}

double rate_of(const v4l2_streamparm& parameters) {
  const v4l2_fract& interval = parameters.parm.capture.timeperframe;
  return interval.numerator == 0 ? 0.0 : static_cast<double>(interval.denominator) / interval.numerator;
}

/// S_PARM, then the rate by G_PARM. A device whose rate cannot be set keeps its own.
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

/// The format first: setting a format resets the rate.
bool try_format(V4l2Device& device, const CameraConfig& config, PixelFormat wanted, V4l2Setup& setup) {
  if (!set_format(device, config, wanted, setup)) return false;
  setup.rate_hz = set_rate(device, config.rate_hz);
  return true;
}

}  // namespace

void set_up_format(V4l2Device& device, const CameraConfig& config, const std::vector<PixelFormat>& without,
                   V4l2Setup& setup) {
  const std::vector<std::uint32_t> offered = offered_formats(device);
  PixelFormat named = PixelFormat::Grey;
  if (parse_pixel_format(config.format, named)) {
    setup.complete = try_format(device, config, named, setup);
    return;
  }
  bool any = false;
  PixelFormat fastest = PixelFormat::Grey;
  double fastest_hz = -1.0;
  for (const PixelFormat candidate : pixel_formats()) {
    if (!is_offered(offered, candidate) ||
        std::find(without.begin(), without.end(), candidate) != without.end())
      continue;
    any = true;
    if (!try_format(device, config, candidate, setup)) continue;
    if (setup.rate_hz >= config.rate_hz * (1.0 - kRateTolerance)) {
      setup.complete = true;
      return;
    }
    if (setup.rate_hz > fastest_hz) {
      fastest = candidate;
      fastest_hz = setup.rate_hz;
    }
  }
  setup.none_left = !any && !without.empty();
  if (!any) {
    std::string names;
    for (const std::uint32_t fourcc : offered) names += (names.empty() ? "" : ", ") + fourcc_text(fourcc);
    setup.problem = fmt::format("offers {} (expected one of GREY, NV12, YUYV, RGB3, BGR3, MJPG)",
                                names.empty() ? "no format" : names);
    return;
  }
  if (fastest_hz >= 0.0) setup.complete = try_format(device, config, fastest, setup);
}

}  // namespace heel
