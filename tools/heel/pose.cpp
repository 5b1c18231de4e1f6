// heel pose: the vision stage of heeld on the frames of images, folders and videos; one result for each
// frame.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commandline/progress.h"
#include "commands.h"
#include "config/config_load.h"
#include "files/camera_info.h"
#include "files/folder.h"
#include "files/frame_input.h"
#include "files/image_file.h"
#include "files/orientation.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "picture.h"
#include "pose_output.h"
#include "turn_options.h"
#include "vision/pose/template_selector.h"
#include "vision/template/turned_template.h"

namespace heel::cli {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

struct PoseOptions {
  std::vector<std::string> inputs;
  std::string config_file;
  std::vector<std::string> template_files;
  std::string camera_file;
  bool json = false;
  bool oriented = false;
  bool independent = false;
  std::string picture_dir;
  std::uint64_t first = 0;
  std::uint64_t last = kNoLimit;
  std::optional<double> rate_hz;
  std::optional<int> max_features;
  std::optional<int> octaves;
  TurnOptions turn;
};

/// What heeld would run with, by the configuration file and the options, which replace the file's values.
struct Setup {
  TargetConfig target;
  TurnedTemplates templates;  ///< of target
  CameraModel sent_camera;    ///< of the inputs
  PictureTurn turn;           ///< of the inputs, before vision sees them
  CameraModel camera;         ///< of the turned pictures
  std::string camera_file;
  double image_rate_hz = 0.0;
  VisionConfig vision;
};

Setup load_setup(const PoseOptions& options) {
  Config config;
  if (!options.config_file.empty()) {
    config = load_config(options.config_file).config;
  } else if (options.template_files.empty() || options.camera_file.empty()) {
    throw Error("expected --config, or both --template and --camera-info (see heel pose --help)");
  }
  Setup setup;
  setup.target = config.target;
  if (!options.template_files.empty()) {
    setup.target.shirt = options.template_files.front();
    setup.target.more_shirts.assign(options.template_files.begin() + 1, options.template_files.end());
  }
  const std::vector<ShirtTemplate> shirts = read_templates(setup.target);
  setup.camera_file = options.camera_file.empty() ? config.camera.info : options.camera_file;
  const CameraFile file = read_camera_file(setup.camera_file);
  if (!file.warning.empty()) fmt::print(stderr, "heel pose: warning: {}\n", file.warning);
  setup.sent_camera = file.camera;
  setup.turn = turn_of(options.turn, config.camera);
  setup.camera = turned_camera(setup.sent_camera, setup.turn);
  setup.templates = templates_for_turned(shirts, setup.sent_camera, setup.turn);
  for (ShirtTemplate& shirt : setup.templates.shirts) shirt.oriented = shirt.oriented || options.oriented;
  setup.image_rate_hz = options.rate_hz.value_or(config.camera.rate_hz);
  setup.vision = config.vision;
  setup.vision.max_features = options.max_features.value_or(config.vision.max_features);
  setup.vision.octaves = options.octaves.value_or(config.vision.octaves);
  return setup;
}

FrameView view_of(const InputFrame& frame) {
  FrameView view = frame_view_of(frame.grey);
  view.header.sequence = frame.number;
  view.header.t_capture_ns = ns_from_seconds(frame.t_s);
  return view;
}

PoseRow estimate(TemplateSelector& templates, const InputFrame& frame, const Setup& setup) {
  const auto start = std::chrono::steady_clock::now();
  const PoseEstimate pose = templates.estimate(view_of(frame));
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  return {frame.number, frame.t_s, pose, elapsed.count(),
          setup.target.more_shirts.empty()
              ? ""
              : template_file(setup.target, setup.templates.taught[pose.template_index])};
}

void write_pose_picture(const std::string& folder, const InputFrame& frame, const PoseEstimate& pose,
                        const ShirtTemplate& shirt, const CameraModel& camera) {
  const std::filesystem::path path =
      std::filesystem::path(folder) / fmt::format("frame_{:06}.png", frame.number);
  write_image(path.string(), draw_pose(frame.grey, pose, shirt, camera));
}

Error no_first_frame(const PoseOptions& options, std::uint64_t frames) {
  const std::string ends = options.inputs.size() == 1
                               ? options.inputs.front() + " ends"
                               : fmt::format("the {} inputs end", options.inputs.size());
  return Error(fmt::format("--first {}: {} after {} frame{} (expected a frame number below {})",
                           options.first, ends, frames, frames == 1 ? "" : "s", frames));
}

/// What is there has been used; the exit status says that it was not all.
void end_with_problems(const FrameInput& input, const char* command) {
  for (const std::string& problem : input.problems()) fmt::print(stderr, "{}: {}\n", command, problem);
  if (!input.problems().empty()) throw CLI::RuntimeError(kExitBadInput);
}

/// Estimates and prints every frame from the first to the last that the options name.
void process_frames(const PoseOptions& options, Setup setup) {
  FrameInput input(options.inputs, setup.image_rate_hz);
  // A single picture has no frame before or after it that could share the work of a search.
  if (options.independent || input.stated_frame_count() == 1) setup.vision.tracking = false;
  TemplateSelector templates(setup.templates.shirts, setup.camera, setup.vision);
  // The results of a terminal are progress enough.
  commandline::Progress progress("frame", input.stated_frame_count(), isatty(STDOUT_FILENO) == 0);
  PoseSummary summary;
  InputFrame frame;
  bool more = input.skip(options.first) && input.next(frame);
  if (!more && options.first > 0) throw no_first_frame(options, input.frames_passed());
  if (!options.json) std::puts(pose_table_head().c_str());
  std::size_t notes = 0;
  for (; more && frame.number <= options.last; more = input.next(frame)) {
    require_size(frame, setup.sent_camera, setup.camera_file);
    if (notes < input.notes().size()) progress.clear();
    for (; notes < input.notes().size(); ++notes) fmt::print(stderr, "heel pose: {}\n", input.notes()[notes]);
    frame.grey = turned_picture(frame.grey, setup.turn);
    const PoseRow row = estimate(templates, frame, setup);
    std::puts((options.json ? pose_json(row) : pose_table_row(row)).c_str());
    summary.add(row);
    if (!options.picture_dir.empty())
      write_pose_picture(options.picture_dir, frame, row.pose,
                         setup.templates.shirts[row.pose.template_index], setup.camera);
    progress.show(frame.number);
  }
  std::fflush(stdout);
  progress.clear();
  fmt::print(stderr, "heel pose: {}\n", summary.line());
  end_with_problems(input, "heel pose");
}

void run_pose(const PoseOptions& options) {
  if (options.last < options.first)
    throw Error(fmt::format("--last {}: before --first {} (expected the same frame or a later one)",
                            options.last, options.first));
  const Setup setup = load_setup(options);
  if (!options.picture_dir.empty()) make_folder(options.picture_dir);
  process_frames(options, setup);
}

}  // namespace

void add_pose_command(CLI::App& app) {
  auto options = std::make_shared<PoseOptions>();
  CLI::App* command = app.add_subcommand(
      "pose",
      "Where the shirt is, and which way it faces, in images, folders of images or videos. Runs what heeld\n"
      "runs: frames follow each other and the shirt is tracked, except with --independent and in a single\n"
      "picture.\n"
      "With --json one object a line: frame (from 0), t_s, found, reason, certainty (inliers / template\n"
      "features), inliers, yaw_rad (positive: walking to the image's right; filtered over a sequence),\n"
      "yaw_sigma_rad, frame_yaw_rad and frame_yaw_sigma_rad (of the frame alone), t_over_d [3],\n"
      "position_m [3] (null when the template's distance is not known), H_cur_from_ref [9] (row-major,\n"
      "undistorted pixels), ms; template, its file, if there are several. In frames in which the shirt is\n"
      "not found the values of the pose are null.");
  command->add_option("inputs", options->inputs, "images, folders of images, videos")
      ->required()
      ->type_name("INPUT");
  command
      ->add_option("--config", options->config_file,
                   "heeld's configuration file: template, camera and [vision] (default: every key at its "
                   "default)")
      ->type_name("FILE");
  command
      ->add_option("--template", options->template_files,
                   "template file made by heel teach; given again: more templates of the same person\n"
                   "(default: target.shirt and target.more_shirts of --config)")
      ->type_name("T.heel")
      ->allow_extra_args(false);
  command
      ->add_option("--camera-info", options->camera_file,
                   "the camera that took the input (default: camera.info of --config)")
      ->type_name("CAM.yaml");
  command->add_flag("--json", options->json, "one JSON object a line (default: a table)");
  command
      ->add_option("--picture-dir", options->picture_dir,
                   "draw the shirt's outline on every frame, into this folder")
      ->type_name("DIR");
  command->add_option("--first", options->first, "first frame processed")
      ->type_name("N")
      ->check(whole_number("a frame number"));
  command->add_option("--last", options->last, "last frame processed")
      ->type_name("N")
      ->check(whole_number("a frame number"));
  command
      ->add_option("--rate", options->rate_hz,
                   "frame rate of images (default: camera.rate_hz of --config, else 30)")
      ->type_name("HZ")
      ->check(number_from(0.001, 10000.0));
  command->add_flag("--independent", options->independent,
                    "the pictures have nothing to do with each other: search each on its own, track nothing");
  command->add_flag("--oriented", options->oriented,
                    "oriented descriptors, also when the template says upright");
  command
      ->add_option("--max", options->max_features,
                   "at most this many features a frame (default: vision.max_features)")
      ->type_name("N")
      ->check(CLI::Range(50, 5000));
  command
      ->add_option("--octaves", options->octaves,
                   "octaves of scale searched in a frame (default: vision.octaves)")
      ->type_name("N")
      ->check(CLI::Range(1, 4));
  add_turn_options(*command, options->turn);
  command->callback([options] { run_pose(*options); });
}

}  // namespace heel::cli
