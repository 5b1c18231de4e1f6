// The steps of `heel preflight` that look through the camera.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "camera_look.h"
#include "core/angles.h"
#include "core/picture_turn.h"
#include "core/state_sentence.h"
#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "preflight_step.h"
#include "vision/picture/picture_monitor.h"
#include "vision/pose/template_selector.h"
#include "vision/template/turned_template.h"

namespace heel::cli {
namespace {

constexpr double kLeastRate = 0.8;  // of camera.rate_hz
constexpr double kMostDamaged = 0.01;
constexpr double kLeastFound = 0.5;
constexpr std::size_t kTurnedFrames = 5;  // are searched in each of the eight ways a camera can be mounted

PreflightStep not_there(PreflightStep step, const Error& error, const char* advice) {
  return step.fail(error.what(), advice_on(error.what(), advice));
}

/// Pictures as the camera sends them, copied.
struct SentPictures {
  std::vector<std::vector<std::uint8_t>> grey;
  std::vector<FrameHeader> headers;

  void add(const FrameView& frame) {
    if (grey.size() >= kTurnedFrames) return;
    std::vector<std::uint8_t> copy;
    for (std::uint32_t y = 0; y < frame.header.height_px; ++y) {
      const std::uint8_t* row = frame.grey + static_cast<std::size_t>(y) * frame.stride_bytes;
      copy.insert(copy.end(), row, row + frame.header.width_px);
    }
    grey.push_back(std::move(copy));
    headers.push_back(frame.header);
  }
};

/// Poses in the pictures when they are turned so.
std::vector<PoseEstimate> poses_of(const SentPictures& sent, const Config& config, const CameraModel& camera,
                                   const PictureTurn& turn) {
  const TurnedTemplates templates = templates_for_turned(read_templates(config.target), camera, turn);
  TemplateSelector vision(templates.shirts, turned_camera(camera, turn), config.vision);
  PictureTurner turner(turn);
  std::vector<PoseEstimate> found;
  for (std::size_t i = 0; i < sent.grey.size(); ++i) {
    FrameView view;
    view.header = sent.headers[i];
    view.grey = sent.grey[i].data();
    view.stride_bytes = sent.headers[i].width_px;
    const PoseEstimate pose = vision.estimate(turner.of(view));
    if (pose.found()) found.push_back(pose);
  }
  return found;
}

/// The way of mounting in which the shirt is found; none where it is not.
std::optional<PictureTurn> turn_that_shows_it(const SentPictures& sent, const Config& config,
                                              const CameraModel& camera) {
  std::optional<PictureTurn> best;
  std::size_t most = 0;
  for (int i = 0; i < 8; ++i) {
    const PictureTurn turn{i >= 4, i % 4};
    const std::size_t found = poses_of(sent, config, camera, turn).size();
    if (found <= most) continue;
    most = found;
    best = turn;
  }
  return best;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

}  // namespace

PreflightStep check_camera(const Config& config) {
  return check_camera_and_use(config, [](const FrameView&) {});
}

PreflightStep check_camera_and_use(const Config& config, const std::function<void(const FrameView&)>& use) {
  PreflightStep step{.name = "camera"};
  try {
    Look look(config.camera);
    PictureMonitor monitor;
    PictureFault fault = PictureFault::None;
    look.take([&](const FrameView& frame) {
      fault = monitor.update(frame);
      use(frame);
    });
    step.values = {{"description", look.description()},
                   {"rate_hz", look.rate_hz()},
                   {"damaged_share", look.damaged_share()},
                   {"picture", picture_sentence(fault)}};
    const std::string measured = fmt::format("{}, {:.1f} pictures/s", look.description(), look.rate_hz());
    if (fault != PictureFault::None) return step.fail(measured, picture_sentence(fault));
    if (look.damaged_share() > kMostDamaged)
      return step.fail(fmt::format("{}, {:.0f} % damaged", measured, 100.0 * look.damaged_share()),
                       "use another cable or USB port, or camera.format = \"YUYV\"");
    if (look.rate_hz() == 0.0 && config.camera.from_file())
      return step.fail(measured, "one picture has no pace (expected a video, or a folder of pictures)");
    if (look.rate_hz() < kLeastRate * config.camera.rate_hz)
      return step.fail(measured, fmt::format("set camera.rate_hz to what it gives, or give it more light and "
                                             "a shorter camera.exposure_ms (expected {:g} pictures/s)",
                                             config.camera.rate_hz));
    return step.pass(measured + ", nothing wrong with the picture");
  } catch (const Error& error) {
    return not_there(step, error,
                     "check camera.source and the cable; `v4l2-ctl --list-devices` names cameras");
  }
}

PreflightStep check_calibration(const Config& config) {
  PreflightStep step{.name = "calibration"};
  try {
    const auto [camera, warning] = read_camera_file(config.camera.info);
    const PictureTurn turn = picture_turn(config.camera.rotate, config.camera.mirror);
    const CameraModel turned = turned_camera(camera, turn);
    const double view_deg =
        2.0 * std::atan(0.5 * turned.width_px / turned.fx) * kDegPerRad;  // without distortion
    step.values = {{"file", config.camera.info},
                   {"width_px", camera.width_px},
                   {"height_px", camera.height_px},
                   {"field_of_view_deg", view_deg},
                   {"warning", warning}};
    return step.pass(fmt::format("{}: {}x{} pixels, {:.0f}° wide{}", config.camera.info, camera.width_px,
                                 camera.height_px, view_deg, warning.empty() ? "" : "; warning: " + warning));
  } catch (const Error& error) {
    return not_there(step, error, "measure the camera: heel calibrate --help");
  }
}

PreflightStep check_shirt(const Config& config) {
  PreflightStep step{.name = "shirt"};
  try {
    const std::vector<ShirtTemplate> shirts = read_templates(config.target);
    const TemplateVerdict verdict = judge_template(shirts.front());
    step.values = {{"file", config.target.shirt},
                   {"templates", shirts.size()},
                   {"features", verdict.features},
                   {"distance_m", shirts.front().distance_m}};
    const std::string measured = fmt::format(
        "{}: {} features, taken at {:.2f} m{}", config.target.shirt, verdict.features,
        shirts.front().distance_m, shirts.size() > 1 ? fmt::format("; {} more", shirts.size() - 1) : "");
    if (!verdict.usable)
      return step.fail(measured + ": " + verdict.reason, "teach another shirt: docs/shirts.md");
    return step.pass(measured);
  } catch (const Error& error) {
    return not_there(step, error, "take the shirt's template: heel teach --help");
  }
}

PreflightStep check_person(const Config& config) {
  PreflightStep step{.name = "person"};
  try {
    const CameraModel camera = read_camera_model(config.camera.info);
    CameraConfig as_sent = config.camera;
    as_sent.rotate = 0;
    as_sent.mirror = false;
    Look look(as_sent);
    SentPictures sent;
    look.take([&](const FrameView& frame) { sent.add(frame); });
    if (look.width_px() != camera.width_px || look.height_px() != camera.height_px)
      return step.fail(fmt::format("the camera sends {}x{} pixels, {} is for {}x{}", look.width_px(),
                                   look.height_px(), config.camera.info, camera.width_px, camera.height_px),
                       "calibrate in the size that is used: camera.width_px and camera.height_px");
    const PictureTurn turn = picture_turn(config.camera.rotate, config.camera.mirror);
    const std::vector<PoseEstimate> found = poses_of(sent, config, camera, turn);
    const double share = static_cast<double>(found.size()) / static_cast<double>(sent.grey.size());
    step.values = {{"found_share", share}};
    if (share < kLeastFound) {
      const std::optional<PictureTurn> other = turn_that_shows_it(sent, config, camera);
      if (other && (other->mirror != turn.mirror || other->quarters != turn.quarters)) {
        step.values["rotate"] = 90 * other->quarters;
        step.values["mirror"] = other->mirror;
        return step.fail(
            "the shirt is found when the picture is turned otherwise than the configuration says",
            fmt::format("set camera.rotate = {} and camera.mirror = {}", 90 * other->quarters,
                        other->mirror));
      }
      return step.fail(fmt::format("the shirt is found in {:.0f} % of the pictures", 100.0 * share),
                       "stand 1 to 3 m before the camera with the back to it, in the taught shirt");
    }
    std::vector<double> certainties, distances;
    for (const PoseEstimate& pose : found) {
      certainties.push_back(pose.certainty);
      distances.push_back(pose.position_m[2]);
    }
    step.values["certainty"] = median(certainties);
    step.values["distance_m"] = median(distances);
    return step.pass(
        fmt::format("found upright in {:.0f} % of the pictures, certainty {:.2f}, {:.2f} m away; "
                    "is that what a tape measure says?",
                    100.0 * share, median(certainties), median(distances)));
  } catch (const Error& error) {
    return not_there(step, error, "pass the steps before this one first");
  }
}

}  // namespace heel::cli
