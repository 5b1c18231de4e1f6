// heel setup: the shirt is taught, from the sharpest of many pictures of the person who stands there.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "back_outline.h"
#include "camera_look.h"
#include "distance_by_driving.h"
#include "files/atomic_file.h"
#include "files/camera_info.h"
#include "files/image_file.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "picture.h"
#include "roi_option.h"
#include "setup_steps.h"
#include "sharpest_picture.h"
#include "teach_reach.h"
#include "vision/template/turned_template.h"

namespace heel::cli {
namespace {

constexpr double kNearest_m = 0.3, kFarthest_m = 10.0;
constexpr std::size_t kLargestTemplate_bytes = std::size_t{64} << 20;
constexpr double kSmallest_m = 0.8, kTallest_m = 2.3;

double asked_metres(Setup& setup, double given_m, double least_m, double most_m, const std::string& question,
                    const std::string& usual, const std::string& option) {
  double metres = given_m;
  if (metres > 0.0) return metres;
  setup.dialogue.ask_until(question, usual, option, [&](const std::string& answer) -> std::string {
    metres = metres_in(answer, least_m, most_m);
    return metres > 0.0 ? "" : fmt::format("metres, {:g} to {:g}", least_m, most_m);
  });
  return metres;
}

/// No distance: the robot is to measure it.
std::optional<double> tape_m(Setup& setup) {
  const SetupOptions& options = setup.options;
  if (options.distance_m > 0.0) return options.distance_m;
  if (options.drive_back) return std::nullopt;
  std::optional<double> metres;
  setup.dialogue.ask_until(
      "From the camera to the back, by tape, metres; or drive: the robot measures it, driving back half a "
      "metre",
      "", "--distance or --drive-back", [&](const std::string& answer) -> std::string {
        metres.reset();
        if (answer == "drive") return "";
        metres = metres_in(answer, kNearest_m, kFarthest_m);
        return *metres > 0.0 ? "" : fmt::format("metres, {:g} to {:g}, or drive", kNearest_m, kFarthest_m);
      });
  return metres;
}

struct PersonThere {
  Person about;             ///< to propose the outline
  double distance_m = 0.0;  ///< 0: not known yet
};

PersonThere ask_for_person(Setup& setup) {
  setup.dialogue.say(
      "The person stands upright in the middle of the picture, 1.5 to 2 m away, the back square to the "
      "camera, arms a little off the body.");
  const std::optional<double> distance_m = tape_m(setup);
  PersonThere there;
  there.distance_m = distance_m.value_or(0.0);
  there.about.distance_m = distance_m
                               ? *distance_m
                               : asked_metres(setup, 0.0, kNearest_m, kFarthest_m,
                                              "How far is the back roughly, metres", "1.6", "--distance");
  there.about.height_m = asked_metres(setup, setup.options.height_m, kSmallest_m, kTallest_m,
                                      "How tall is the person, metres", "1.75", "--height");
  return there;
}

/// The distance by the robot itself. Throws heel::Error, also without consent.
void drive_for_distance(Setup& setup, ShirtTemplate& shirt) {
  const bool consented =
      std::exchange(setup.drive_back_consented, false) ||
      setup.dialogue.consents(
          "The robot drives half a metre back now, slowly. If a metre behind it is free, nobody is there, a "
          "hand "
          "is at its STOP button, and the person goes on standing still: type back (Enter: not now)",
          "back");
  if (!consented) throw Error("nothing was moved, so the distance is not known (expected --distance)");
  const DrivenDistance driven = distance_by_driving_back(shirt, setup.file.config());
  if (g_preflight_interrupted) throw SetupInterrupted();
  shirt.distance_m = driven.distance_m;
  setup.dialogue.say(fmt::format("Driven {:.2f} m back: the back was {:.2f} ± {:.2f} m away (now farther).",
                                 driven.driven_m, driven.distance_m, driven.sigma_m));
}

/// Draws the region and lets the person correct it.
void agree_on_region(Setup& setup, ShirtTemplate& shirt) {
  const std::string file = setup.file.beside("setup-shirt.png");
  for (bool agreed = false; !agreed;) {
    write_image(file, draw_template(shirt, template_features(shirt)));
    const Region& roi = shirt.roi;
    const std::string question = fmt::format(
        "Look at {}. Is the outline {},{},{},{} on the back, without arms, collar and background? "
        "yes, or a better X,Y,W,H",
        file, roi.x_px, roi.y_px, roi.width_px, roi.height_px);
    setup.dialogue.ask_until(question, "yes", "--roi", [&](const std::string& answer) -> std::string {
      agreed = answer == "yes" || answer == "y";
      if (agreed) return "";
      return read_roi(answer, shirt.camera, shirt.roi);
    });
  }
}

/// The sharpest of the pictures of some seconds, upright.
cv::Mat sharpest_picture(Setup& setup) {
  SharpestPicture sharpest;
  Look look(setup.file.config().camera);
  look.take([&](const FrameView& frame) { sharpest.add(frame); });
  if (g_preflight_interrupted) throw SetupInterrupted();
  setup.dialogue.say(fmt::format("The sharpest of {} pictures is taken.", look.frames()));
  return sharpest.grey();
}

ShirtTemplate taught_shirt(Setup& setup) {
  const Config& config = setup.file.config();
  const PictureTurn turn = picture_turn(config.camera.rotate, config.camera.mirror);
  ShirtTemplate shirt;
  shirt.camera = turned_camera(read_camera_model(config.camera.info), turn);
  shirt.upright = true;
  const PersonThere person = ask_for_person(setup);
  count_down(setup.dialogue, setup.options.countdown_s);
  const cv::Mat grey = sharpest_picture(setup);
  if (grey.cols != shirt.camera.width_px || grey.rows != shirt.camera.height_px)
    throw Error(fmt::format("the camera sends {}x{} pixels (expected {}x{} as in {})", grey.cols, grey.rows,
                            shirt.camera.width_px, shirt.camera.height_px, config.camera.info));
  shirt.grey.assign(grey.datastart, grey.dataend);
  shirt.distance_m = person.distance_m;
  shirt.roi = setup.options.roi.empty() ? proposed_back(grey, shirt.camera, config.camera, person.about)
                                        : parse_roi(setup.options.roi, shirt.camera);
  if (shirt.roi.width_px == 0)
    throw Error(
        "at this distance the back is not in the picture (expected camera.mount_z_m and "
        "camera.mount_pitch_rad "
        "as the camera is mounted, or --roi)");
  if (setup.options.roi.empty()) agree_on_region(setup, shirt);
  return shirt;
}

/// The template is found in the person who still stands there.
PreflightStep judged_step(Setup& setup, const ShirtTemplate& shirt) {
  const Config& config = setup.file.config();
  setup.dialogue.say("Stay: it is measured how far this shirt is found, and whether it is found now ...");
  PreflightStep step = check_shirt(config);
  if (step.verdict != StepVerdict::Pass) return step;
  const Region& roi = shirt.roi;
  step.values["distance_m"] = shirt.distance_m;
  step.values["roi"] = {roi.x_px, roi.y_px, roi.width_px, roi.height_px};
  if (setup.options.reach_time_s > 0.0) {
    const TemplateReach reach = measured_reach(shirt, shirt.camera, setup.options.reach_time_s);
    step.values["reach"] = reach_json(reach);
    step.measured += "; " + in_one_line(reach);
    if (const std::string warning = reach_warning(reach); !warning.empty())
      setup.dialogue.say("  warning: " + warning);
  }
  const PreflightStep person = check_person(config);
  step.values["person"] = person.values;
  if (person.verdict != StepVerdict::Pass)
    return step.fail(step.measured + "; " + person.measured, person.advice);
  step.measured += "; " + person.measured;
  return step;
}

}  // namespace

PreflightStep set_up_shirt(Setup& setup) {
  PreflightStep step{.name = "shirt"};
  const std::string& file = setup.file.config().target.shirt;
  try {
    require_folder_takes(file);
    if (!setup.options.again("shirt") && std::filesystem::exists(file)) {
      step = check_shirt(setup.file.config());
      if (step.verdict == StepVerdict::Pass &&
          setup.dialogue.yes(step.measured + ". Keep this shirt?", true, "--step shirt"))
        return step;
    }
    ShirtTemplate shirt = taught_shirt(setup);
    const TemplateVerdict verdict = judge_template(shirt);
    if (!verdict.usable)
      return step.fail(fmt::format("{} features in the outline: {}", verdict.features, verdict.reason),
                       "another shirt (docs/shirts.md), or an outline that fits better: --roi");
    if (shirt.distance_m == 0.0) drive_for_distance(setup, shirt);
    const std::string before =
        std::filesystem::is_regular_file(file) ? read_whole_file(file, kLargestTemplate_bytes) : "";
    write_template(shirt, file);
    step = judged_step(setup, shirt);
    if (step.verdict != StepVerdict::Pass && !before.empty()) {
      write_file_atomically(file, before);
      step.measured += "; the shirt taught before is kept";
    }
    return step;
  } catch (const NoAnswer&) {
    throw;  // no fault of the shirt
  } catch (const Error& error) {
    return step.fail(error.what(),
                     advice_on(error.what(), "do what it says, or pass the steps before first"));
  }
}

}  // namespace heel::cli
