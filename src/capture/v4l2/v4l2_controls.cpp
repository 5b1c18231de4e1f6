#include "capture/v4l2/v4l2_controls.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <cmath>

namespace heel {

namespace {

constexpr double kExposureUnit_s = 100e-6;  // of V4L2_CID_EXPOSURE_ABSOLUTE

struct Range {
  bool known = false;
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

/// For a control that the device need not have.
void set_if_known(V4l2Device& device, std::uint32_t id, std::int32_t value) {
  if (range_of(device, id).known) set_control(device, id, value);
}

/// A control whose value the configuration fixes.
struct WantedControl {
  std::uint32_t id;
  const char* key;         ///< of the configuration
  const char* name;        ///< of the control
  double value;            ///< as configured
  double unit;             ///< control units for one configured unit
  const char* free_value;  ///< the configured value that leaves the control to the device
};

/// Sets the control and reads it back, in control units. False: setup.problem says why.
bool set_and_verify(V4l2Device& device, const WantedControl& wanted, V4l2Setup& setup,
                    std::int32_t& read_back) {
  const auto refuse = [&](const std::string& why) {
    setup.problem = fmt::format("{} = {:g}: {}", wanted.key, wanted.value, why);
    return false;
  };
  const Range range = range_of(device, wanted.id);
  if (!range.known) {
    return refuse(
        fmt::format("the device has no control of its {} (expected {})", wanted.name, wanted.free_value));
  }
  const double in_units = wanted.value * wanted.unit;
  if (in_units < range.least - 0.5 || in_units > range.most + 0.5) {
    return refuse(fmt::format("the device's {} goes from {:g} to {:g}", wanted.name,
                              range.least / wanted.unit, range.most / wanted.unit));
  }
  const auto value = static_cast<std::int32_t>(std::lround(in_units));
  v4l2_control control{.id = wanted.id, .value = 0};
  if (!set_control(device, wanted.id, value) || device.control(VIDIOC_G_CTRL, &control) != 0) {
    return refuse(fmt::format("the device refuses this {}", wanted.name));
  }
  if (std::abs(control.value - value) > range.step) {
    return refuse(
        fmt::format("the device sets its {} to {:g} instead", wanted.name, control.value / wanted.unit));
  }
  read_back = control.value;
  setup.controls +=
      fmt::format("{}{} {:g}", setup.controls.empty() ? "" : ", ", wanted.name, control.value / wanted.unit);
  return true;
}

bool set_up_exposure(V4l2Device& device, const CameraConfig& config, V4l2Setup& setup) {
  // In both cases the camera must not lower its rate for a longer exposure.
  set_if_known(device, V4L2_CID_EXPOSURE_AUTO_PRIORITY, 0);
  if (config.exposure_ms <= 0.0) {
    if (!range_of(device, V4L2_CID_EXPOSURE_AUTO).known) return true;
    // Cameras with a fixed iris call automatic exposure "aperture priority"; others have only "auto".
    if (!set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY)) {
      set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_AUTO);
    }
    return true;
  }
  if (range_of(device, V4L2_CID_EXPOSURE_AUTO).known &&
      !set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL)) {
    set_control(device, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_SHUTTER_PRIORITY);
  }
  std::int32_t units = 0;
  if (!set_and_verify(device,
                      {V4L2_CID_EXPOSURE_ABSOLUTE, "camera.exposure_ms", "exposure (ms)", config.exposure_ms,
                       1e-3 / kExposureUnit_s, "0 (automatic)"},
                      setup, units)) {
    return false;
  }
  setup.exposure_s = units * kExposureUnit_s;
  return true;
}

}  // namespace

bool set_up_controls(V4l2Device& device, const CameraConfig& config, V4l2Setup& setup) {
  std::int32_t ignored = 0;
  if (!set_up_exposure(device, config, setup)) return false;
  if (config.gain >= 0.0) {
    set_if_known(device, V4L2_CID_AUTOGAIN, 0);
    const WantedControl gain{V4L2_CID_GAIN, "camera.gain", "gain", config.gain, 1.0, "-1 (automatic)"};
    if (!set_and_verify(device, gain, setup, ignored)) return false;
  } else {
    set_if_known(device, V4L2_CID_AUTOGAIN, 1);
  }
  if (config.focus >= 0.0) {
    set_if_known(device, V4L2_CID_FOCUS_AUTO, 0);
    const WantedControl focus{V4L2_CID_FOCUS_ABSOLUTE, "camera.focus", "focus", config.focus, 1.0,
                              "-1 (unchanged)"};
    if (!set_and_verify(device, focus, setup, ignored)) return false;
  }
  return true;
}

}  // namespace heel
