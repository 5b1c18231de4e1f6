// heel teach: one view of a shirt's back → a template file, and how well the shirt can be followed.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "capture/factory/frame_source_factory.h"
#include "capture/frame_source.h"
#include "card_distance.h"
#include "card_sheet.h"
#include "commands.h"
#include "core/angles.h"
#include "files/camera_info.h"
#include "files/frame_input.h"
#include "files/image_file.h"
#include "files/orientation.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "heel/shirt_template.h"
#include "picture.h"
#include "roi_option.h"
#include "teach_more.h"
#include "teach_reach.h"
#include "turn_options.h"
#include "vision/template/turned_template.h"

namespace heel::cli {
namespace {

constexpr TimeNs kFrameTimeout_ns = kNsPerS;
constexpr TimeNs kLongestSilence_ns = 10 * kNsPerS;
constexpr double kMostCardMiss = 0.05;         // of the distance: the card against the tape
constexpr std::uint64_t kSettlingFrames = 30;  // the camera's automatic exposure has settled by then

using TeachJson = nlohmann::ordered_json;

struct TeachOptions {
  std::string image;
  std::string camera_address;
  std::vector<std::string> roi;
  std::optional<double> distance_m;
  std::string card;
  double card_square_m = kCardSquare_m;
  double yaw_deg = 0.0;
  std::string camera_file;
  std::string robot_camera_file;
  double reach_time_s = 8.0;
  std::vector<std::string> more;
  std::string output;
  std::string picture;
  bool oriented = false;
  int max_features = 0;
  std::optional<std::uint64_t> frame;
  TurnOptions turn;
  bool json = false;
};

/// Number of the frame to take.
std::uint64_t wanted_frame(const TeachOptions& options) {
  const bool device = !options.camera_address.empty() && !options.camera_address.starts_with("file:");
  return options.frame.value_or(device ? kSettlingFrames : 0);
}

std::vector<std::uint8_t> grey_from_file(const TeachOptions& options, int& width_px, int& height_px) {
  FrameInput input({options.image}, 30.0);
  InputFrame frame;
  if (!input.skip(wanted_frame(options)) || !input.next(frame)) {
    const std::string why = input.problems().empty() ? "" : " (" + input.problems().front() + ")";
    throw Error(
        fmt::format("--frame {}: {} ends before that frame{}", wanted_frame(options), options.image, why));
  }
  for (const std::string& note : input.notes()) fmt::print(stderr, "heel teach: {}\n", note);
  const cv::Mat grey = turned_picture(frame.grey, turn_of(options.turn));
  width_px = grey.cols;
  height_px = grey.rows;
  return {grey.datastart, grey.dataend};
}

std::vector<std::uint8_t> grey_from_camera(const TeachOptions& options, int& width_px, int& height_px) {
  CameraConfig config;
  config.source = options.camera_address;
  config.width_px = width_px;
  config.height_px = height_px;
  config.file_speed = 0.0;
  config.rotate = options.turn.rotate.value_or(0);
  config.mirror = options.turn.mirror;
  const std::unique_ptr<FrameSource> source = open_frame_source(config);
  const std::uint64_t wanted = wanted_frame(options);
  FrameView view;
  TimeNs silent_ns = 0;  // a source that works says itself when it has waited long enough
  for (std::uint64_t received = 0; received <= wanted;) {
    const FrameResult result = source->wait_frame(kFrameTimeout_ns, view);
    if (result == FrameResult::Frame) {
      ++received;
      silent_ns = 0;
      continue;
    }
    if (result == FrameResult::Timeout && (silent_ns += kFrameTimeout_ns) < kLongestSilence_ns) continue;
    throw Error(fmt::format("{}: {} (expected frame {}, got {} frames)", options.camera_address,
                            source->problem().empty() ? to_string(result) : source->problem(), wanted,
                            received));
  }
  width_px = static_cast<int>(view.header.width_px);
  height_px = static_cast<int>(view.header.height_px);
  std::vector<std::uint8_t> grey;
  for (int y = 0; y < height_px; ++y) {
    const std::uint8_t* row = view.grey + static_cast<std::size_t>(y) * view.stride_bytes;
    grey.insert(grey.end(), row, row + width_px);
  }
  return grey;
}

/// What the picture of the card says, which must not contradict --distance.
std::optional<CardDistance> measured_card(const TeachOptions& options, const CameraModel& camera) {
  if (options.card.empty()) return std::nullopt;
  FrameInput input({options.card}, 30.0);
  InputFrame frame;
  if (!input.next(frame)) throw Error(fmt::format("--card {}: no picture in it", options.card));
  frame.grey = turned_picture(frame.grey, turn_of(options.turn));
  require_size(frame, camera, options.camera_file);
  CardDistance card;
  try {
    card = distance_of_card(frame.grey, camera, options.card_square_m);
  } catch (const Error& error) {
    throw Error(fmt::format("--card {}: {}", options.card, error.what()));
  }
  const double tape_m = options.distance_m.value_or(card.distance_m);
  if (std::abs(card.distance_m - tape_m) > kMostCardMiss * tape_m)
    throw Error(fmt::format(
        "--card {}: the card is {:.2f} m away, and --distance says {:g} m (expected the same to {:g} %: it "
        "may be printed at {:.0f} %, see its line of {:g} mm, or the distance was not measured along the "
        "view)",
        options.card, card.distance_m, tape_m, 100.0 * kMostCardMiss, 100.0 * tape_m / card.distance_m,
        1000.0 * kCardLine_m));
  return card;
}

ShirtTemplate make_template(const TeachOptions& options, std::optional<CardDistance>& card) {
  ShirtTemplate shirt;
  const auto [sent_camera, warning] = read_camera_file(options.camera_file);
  if (!warning.empty()) fmt::print(stderr, "heel teach: warning: {}\n", warning);
  const PictureTurn turn = turn_of(options.turn);
  shirt.camera = turned_camera(sent_camera, turn);
  shirt.upright = turn.any() || options.turn.rotate.has_value();
  int width_px = sent_camera.width_px;
  int height_px = sent_camera.height_px;
  shirt.grey = options.image.empty() ? grey_from_camera(options, width_px, height_px)
                                     : grey_from_file(options, width_px, height_px);
  if (width_px != shirt.camera.width_px || height_px != shirt.camera.height_px) {
    throw Error(fmt::format("{}: {}x{} pixels (expected {}x{} as in {})",
                            options.image.empty() ? options.camera_address : options.image, width_px,
                            height_px, shirt.camera.width_px, shirt.camera.height_px, options.camera_file));
  }
  shirt.roi = parse_roi(options.roi, shirt.camera);
  card = measured_card(options, shirt.camera);
  shirt.distance_m = options.distance_m ? *options.distance_m : card->distance_m;
  shirt.yaw_rad = options.yaw_deg / kDegPerRad;
  shirt.oriented = options.oriented;
  if (options.max_features > 0) shirt.max_features = options.max_features;
  return shirt;
}

void print_verdict(const ShirtTemplate& shirt, const TemplateVerdict& verdict) {
  fmt::print("{:4} features in the {} x {} px region\n", verdict.features, shirt.roi.width_px,
             shirt.roi.height_px);
  fmt::print("{:4.0f} % of the region holds features\n", 100.0 * verdict.spread);
  fmt::print("{:4.0f} % of the features are too similar to another one\n", 100.0 * verdict.self_similarity);
  fmt::print("{:4.0f} % of the features are still found from twice the distance\n",
             100.0 * verdict.coarse_share);
}

TeachJson card_json(const std::optional<CardDistance>& card) {
  if (!card) return nullptr;
  return {{"distance_m", card->distance_m},
          {"sigma_m", card->sigma_m},
          {"tilt_rad", card->tilt_rad},
          {"rms_px", card->rms_px}};
}

TeachJson json_of(const TeachOptions& options, const TemplateVerdict& verdict) {
  return {{"usable", verdict.usable},
          {"reason", verdict.reason},
          {"output", verdict.usable ? options.output : ""},
          {"features", verdict.features},
          {"spread", verdict.spread},
          {"self_similarity", verdict.self_similarity},
          {"coarse_share", verdict.coarse_share},
          {"reach", nullptr}};
}

/// Measures how far the shirt is found, and prints everything.
void print_results(const TeachOptions& options, const ShirtTemplate& shirt,
                   const std::optional<CardDistance>& card, const TemplateVerdict& verdict,
                   const CameraModel& robot_camera) {
  const bool measures = verdict.usable && options.reach_time_s > 0.0;
  if (options.json) {
    TeachJson json = json_of(options, verdict);
    json["distance_m"] = shirt.distance_m;
    json["card"] = card_json(card);
    if (measures) json["reach"] = reach_json(measured_reach(shirt, robot_camera, options.reach_time_s));
    fmt::print("{}\n", json.dump(2));
    return;
  }
  if (card)
    fmt::print("the card is {:.3f} m ± {:.3f} m away, turned by {:.0f}°\n", card->distance_m, card->sigma_m,
               card->tilt_rad * kDegPerRad);
  print_verdict(shirt, verdict);
  if (!verdict.usable) fmt::print("refused: {}\n", verdict.reason);
  if (measures) print_reach(measured_reach(shirt, robot_camera, options.reach_time_s), options.reach_time_s);
  if (verdict.usable) fmt::print("wrote {}\n", options.output);
}

void run_teach(const TeachOptions& options) {
  if (options.image.empty() == options.camera_address.empty()) {
    throw Error("expected either --image or --camera (see heel teach --help)");
  }
  if (!options.picture.empty()) require_writable_image_name(options.picture);
  if (!options.distance_m && options.card.empty()) {
    throw Error("expected --distance, or --card (see heel teach --help)");
  }
  std::optional<CardDistance> card;
  ShirtTemplate shirt = make_template(options, card);
  const CameraModel robot_camera =
      options.robot_camera_file.empty()
          ? shirt.camera
          : turned_camera(read_camera_model(options.robot_camera_file), turn_of(options.turn));
  const TemplateVerdict verdict = judge_template(shirt);
  if (!options.picture.empty()) write_image(options.picture, draw_template(shirt, template_features(shirt)));
  if (verdict.usable) {
    if (!options.more.empty())
      shirt.further_views = further_views(shirt, options.more, options.camera_file, turn_of(options.turn));
    write_template(shirt, options.output);
  }
  print_results(options, shirt, card, verdict, robot_camera);
  if (!verdict.usable) throw CLI::RuntimeError(kExitNo);
}

}  // namespace

void add_teach_command(CLI::App& app) {
  auto options = std::make_shared<TeachOptions>();
  CLI::App* command = app.add_subcommand(
      "teach",
      "Makes a template from one view of the back of a shirt, with the camera square to the back, and says\n"
      "how well it can be followed. A shirt that cannot be followed is refused with the reason (exit status\n"
      "1, nothing written). For a usable shirt it measures, on pictures made from the view, at which "
      "distances\n"
      "and turns the robot's camera finds it, and prints a table: pictures found / pictures made.");
  command->add_option("--image", options->image, "photograph or video of the back")->type_name("IMAGE");
  command
      ->add_option("--camera", options->camera_address,
                   "take the view now: v4l2:PATH, libcamera:ID, file:PATH, sim:NAME")
      ->type_name("SPEC");
  command
      ->add_option("--frame", options->frame,
                   "number of the frame of a video or camera, from 0 (default 0; for a device 30, when its "
                   "exposure has\nsettled)")
      ->type_name("N")
      ->check(whole_number("a frame number"));
  command
      ->add_option("--roi", options->roi,
                   "the back in the image, pixels, without arms, collar and background")
      ->required()
      ->expected(1, 4)
      ->type_name("X,Y,W,H");
  command
      ->add_option("--distance", options->distance_m,
                   "from the camera to the back, metres, along the view; required without --card")
      ->type_name("M")
      ->check(metres_from(0.1, 100.0));
  command
      ->add_option(
          "--card", options->card,
          "picture by the same camera of the printed card (heel card) against the back, the person at "
          "the\nplace of the view: the distance is measured; with --distance it is compared")
      ->type_name("IMAGE");
  command
      ->add_option("--card-square", options->card_square_m,
                   "side of a square of the card as printed, metres (default 0.034)")
      ->type_name("M")
      ->check(metres_from(0.005, 0.5));
  command
      ->add_option("--yaw", options->yaw_deg,
                   "how far the person is turned in the view: 0 from behind (default), 90 walking to the\n"
                   "image's right, -90 to its left, 180 from the front; for target.more_shirts")
      ->type_name("DEG")
      ->check(number_from(-180.0, 180.0));
  command->add_option("--camera-info", options->camera_file, "the camera (heel calibrate makes this file)")
      ->required()
      ->type_name("CAM.yaml");
  command
      ->add_option("--reach-time", options->reach_time_s,
                   "longest time for measuring the reach, seconds; 0: it is not measured (default 8)")
      ->type_name("S")
      ->check(number_from(0.0, 3600.0));
  command
      ->add_option("--more", options->more,
                   "further pictures of the same back by the same camera, turned by any angle: they help to "
                   "find it there")
      ->expected(1, kMaxFurtherViews)
      ->type_name("IMAGE...");
  command
      ->add_option("--robot-camera-info", options->robot_camera_file,
                   "the robot's camera, for which the reach is measured (default: that of --camera-info)")
      ->type_name("CAM.yaml");
  command->add_option("-o,--output", options->output, "template file to write")
      ->required()
      ->type_name("T.heel");
  command->add_option("--picture", options->picture, "also draw the region and its features")
      ->type_name("P.png");
  command->add_flag("--oriented", options->oriented, "descriptors that tolerate rotation in the image");
  command
      ->add_option("--max", options->max_features, "largest number of features, the strongest (default 300)")
      ->type_name("N")
      ->check(CLI::Range(20, 5000));
  add_turn_options(*command, options->turn);
  command->add_flag("--json", options->json, "one JSON object (default: text)");
  command->callback([options] { run_teach(*options); });
}

}  // namespace heel::cli
