// heel setup: the camera is chosen, its picture measured and made upright.
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "capture/factory/source_address.h"
#include "device_list.h"
#include "files/image_file.h"
#include "files/orientation.h"
#include "heel/error.h"
#include "setup_steps.h"
#include "sharpest_picture.h"

namespace heel::cli {
namespace {

constexpr double kLeastUsefulRate_hz = 8.0;  // of the pictures of a person who is followed

constexpr const char* kExpectedCamera =
    "a number of the list or an address: v4l2:PATH, libcamera:ID, file:PATH or sim:NAME";

struct ChoosableCamera {
  std::string address, name;
};

std::vector<ChoosableCamera> choosable_cameras(const SetupFile& file) {
  std::vector<ChoosableCamera> cameras;
  if (file.sets("camera.source")) cameras.push_back({file.config().camera.source, "of the configuration"});
  for (const ListedDevice& device : video_devices())
    if (cameras.empty() || "v4l2:" + device.path != cameras.front().address)
      cameras.push_back({"v4l2:" + device.path, device.name});
  return cameras;
}

/// The address of number `text` of the list, or the address that it is. Throws heel::Error.
std::string camera_of(const std::string& text, const std::vector<ChoosableCamera>& cameras) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  if (is_number && number >= 1 && number <= cameras.size()) return cameras[number - 1].address;
  parse_source_address(text);
  return address_from_here(text);
}

std::string chosen_camera(Setup& setup) {
  if (!setup.options.camera.empty()) return camera_of(setup.options.camera, {});
  const std::vector<ChoosableCamera> cameras = choosable_cameras(setup.file);
  for (std::size_t i = 0; i < cameras.size(); ++i)
    setup.dialogue.say(fmt::format("  {}  {}  {}", i + 1, cameras[i].address, cameras[i].name));
  if (cameras.empty()) setup.dialogue.say("  no V4L2 camera is there");
  std::string address;
  setup.dialogue.ask_until(
      "Which camera? Its number, or an address as v4l2:PATH or libcamera:ID", cameras.empty() ? "" : "1",
      "--camera", [&](const std::string& answer) {
        try {
          address = camera_of(answer, cameras);
          return std::string();
        } catch (const Error&) {
          return std::string(kExpectedCamera) +
                 (answer.find("://") == std::string::npos ? "" : "; heel reads no stream from a network");
        }
      });
  return address;
}

/// A camera that gives fewer pictures than the configuration says, and enough: that many.
bool takes_lower_rate(Setup& setup, const PreflightStep& step, CameraConfig& camera) {
  if (step.verdict != StepVerdict::Fail || !step.values.contains("rate_hz")) return false;
  const double rate_hz = std::round(step.values["rate_hz"].get<double>());
  if (rate_hz < kLeastUsefulRate_hz || rate_hz >= camera.rate_hz) return false;
  const std::string question = fmt::format(
      "It gives {:g} pictures/s, camera.rate_hz is {:g}. Go on with {:g}?", rate_hz, camera.rate_hz, rate_hz);
  if (!setup.dialogue.yes(question, true, "another camera")) return false;
  camera.rate_hz = rate_hz;
  return true;
}

/// How the answer turns pictures that are mirrored and turned as `camera` says; no value: no answer to this.
bool apply_turn(const std::string& answer, CameraConfig& camera) {
  if (answer == "mirror") {
    camera.mirror = !camera.mirror;
    camera.rotate = (360 - camera.rotate) % 360;  // what is seen is mirrored, after it was turned
    return true;
  }
  for (const int degrees : {90, 180, 270}) {
    if (answer != std::to_string(degrees)) continue;
    camera.rotate = (camera.rotate + degrees) % 360;
    return true;
  }
  return false;
}

/// Sets camera.rotate and camera.mirror as the person sees it.
void make_upright(Setup& setup, const cv::Mat& as_sent, CameraConfig& camera) {
  const std::string file = setup.file.beside("setup-camera.png");
  const auto save = [&] {
    write_image(file, turned_picture(as_sent, picture_turn(camera.rotate, camera.mirror)));
  };
  const TurnOptions& turn = setup.options.turn;
  if (turn.rotate || turn.mirror) {
    camera.rotate = turn.rotate.value_or(camera.rotate);
    camera.mirror = turn.mirror || camera.mirror;
    save();
    return;
  }
  for (;;) {
    save();
    bool upright = false;
    setup.dialogue.ask_until(
        "Look at " + file +
            ". Upright, and writing in it can be read? yes, or what is to be done: 90, 180 or 270 "
            "(degrees clockwise), mirror",
        "yes", "--rotate and --mirror", [&](const std::string& answer) {
          upright = answer == "yes" || answer == "y";
          return upright || apply_turn(answer, camera) ? "" : "yes, 90, 180, 270 or mirror";
        });
    if (upright) return;
  }
}

}  // namespace

PreflightStep set_up_camera(Setup& setup) {
  Config wanted = setup.file.config();
  wanted.camera.source = chosen_camera(setup);
  setup.dialogue.say(fmt::format("Looking through {} for some seconds ...", wanted.camera.source));
  Config as_sent = wanted;
  as_sent.camera.rotate = 0;
  as_sent.camera.mirror = false;
  SharpestPicture sharpest;
  const auto look = [&] {
    return check_camera_and_use(as_sent, [&](const FrameView& frame) { sharpest.add(frame); });
  };
  PreflightStep step = look();
  if (takes_lower_rate(setup, step, as_sent.camera)) step = look();
  if (sharpest.grey().empty()) return step;

  wanted.camera.rate_hz = as_sent.camera.rate_hz;
  wanted.camera.width_px = sharpest.grey().cols;
  wanted.camera.height_px = sharpest.grey().rows;
  setup.file.write(wanted);  // the camera is found, whatever is wrong with its picture
  make_upright(setup, sharpest.grey(), wanted.camera);
  setup.file.write(wanted);
  step.values["width_px"] = wanted.camera.width_px;
  step.values["height_px"] = wanted.camera.height_px;
  step.values["rotate"] = wanted.camera.rotate;
  step.values["mirror"] = wanted.camera.mirror;
  return step;
}

}  // namespace heel::cli
