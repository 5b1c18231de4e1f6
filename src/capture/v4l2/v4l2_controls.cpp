#include "capture/v4l2/v4l2_controls.h"

#include <linux/videodev2.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace heel {

namespace {

constexpr double kExposureUnit_s = 100e-6;  // of V4L2_CID_EXPOSURE_ABSOLUTE

struct Range {
  bool there = false;
  std::int32_t least = 0;
  std::int32_t most = 0;
  std::int32_t step = 1;
};

Range range_of(V4l2Device& device, std::uint32_t id) {
  v4l2_queryctrl query{};
  query.id = id;
  if (device.control(VIDIOC_QUERYCTRL, &query) != 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0)
    return {};
  return {true, query.minimum, query.maximum, query.step > 0 ? query.step : 1};
}

bool set_control(V4l2Device& device, std::uint32_t id, std::int32_t value) {
  v4l2_control control{.id = id, .value = value};
  return device.control(VIDIOC_S_CTRL, &control) == 0;
}

/// For what is good to have: missing is fine.
void set_if_there(V4l2Device& device, std::uint32_t id, std::int32_t value) {
  if (range_of(device, id).there) set_control(device, id, value);
}

std::string plain(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

/// A value the configuration names, in the control's own unit.
struct WantedControl {
  std::uint32_t id;
  const char* key;         ///< of the configuration
  const char* name;        ///< of the control
  double value;            ///< as configured
  double unit;             ///< control units for one configured unit
  const char* free_value;  ///< what to configure to leave it to the device
};

/// Sets it and reads it back. The result in control units, or the problem.
bool fix(V4l2Device& device, const WantedControl& wanted, V4l2Agreement& agreement, std::int32_t& read_back) {
  const std::string asked = std::string(wanted.key) + " = " + plain(wanted.value);
  const Range range = range_of(device, wanted.id);
  if (!range.there) {
    agreement.problem =
        asked + ": the device has no control of its " + wanted.name + "; expected " + wanted.free_value;
    return false;
  }
  const double in_units = wanted.value * wanted.unit;
  if (in_units < range.least - 0.5 || in_units > range.most + 0.5) {
    agreement.problem = asked + ": the device's " + wanted.name + " goes from " +
                        plain(range.least / wanted.unit) + " to " + plain(range.most / wanted.unit);
    return false;
  }
  const auto value = static_cast<std::int32_t>(std::lround(in_units));
  v4l2_control control{.id = wanted.id, .value = 0};
  if (!set_control(device, wanted.id, value) || device.control(VIDIOC_G_CTRL, &control) != 0) {
    agreement.problem = asked + ": the device refuses this " + wanted.name;
    return false;
  }
  if (std::abs(control.value - value) > range.step) {
    agreement.problem = asked + ": the device sets its " + wanted.name + " to " +
                        plain(control.value / wanted.unit) + " instead";
    return false;
  }
  read_back = control.value;
  agreement.controls += (agreement.controls.empty() ? "" : ", ") + std::string(wanted.name) + " " +
                        plain(control.value / wanted.unit);
  return true;
}

bool agree_on_exposure(V4l2Device& device, const CameraConfig& config, V4l2Agreement& agreement) {
  // Automatic or not, the rate must not be traded for light.
  set_if_there(device, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);
  if (config.exposure_ms <= 0.0) {
    if (!range_of(device, V4L2_CID_EXPOSURE_AUTO).there) return true;
    // Cameras with a fixed iris call automatic exposure "aperture priority"; others know only "auto".
    if (!set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY)) {
      set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_AUTO);
    }
    return true;
  }
  if (range_of(device, V4L2_CID_EXPOSURE_AUTO).there &&
      !set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL)) {
    set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_SHUTTER_PRIORITY);
  }
  std::int32_t units = 0;
  if (!fix(device,
           {V4L2_CID_EXPOSURE_ABSOLUTE, "camera.exposure_ms", "exposure (ms)", config.exposure_ms,
            1e-3 / kExposureUnit_s, "0 (automatic)"},
           agreement, units)) {
    return false;
  }
  agreement.exposure_s = units * kExposureUnit_s;
  return true;
}

}  // namespace

bool agree_on_controls(V4l2Device& device, const CameraConfig& config, V4l2Agreement& agreement) {
  std::int32_t ignored = 0;
  if (!agree_on_exposure(device, config, agreement)) return false;
  if (config.gain >= 0.0) {
    set_if_there(device, V4L2_CID_AUTOGAIN, 0);
    const WantedControl gain{V4L2_CID_GAIN, "camera.gain", "gain", config.gain, 1.0, "-1 (automatic)"};
    if (!fix(device, gain, agreement, ignored)) return false;
  } else {
    set_if_there(device, V4L2_CID_AUTOGAIN, 1);
  }
  if (config.focus >= 0.0) {
    set_if_there(device, V4L2_CID_FOCUS_AUTO, 0);
    const WantedControl focus{V4L2_CID_FOCUS_ABSOLUTE, "camera.focus", "focus", config.focus, 1.0,
                              "-1 (left alone)"};
    if (!fix(device, focus, agreement, ignored)) return false;
  }
  return true;
}

}  // namespace heel
