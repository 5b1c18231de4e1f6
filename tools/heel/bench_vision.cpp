// heel bench vision: the vision stages beside OpenCV's features, matcher and homography, in one run.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commandline/progress.h"
#include "commands.h"
#include "evaluation/benchmarks/vision_report.h"
#include "evaluation/reports/plots.h"
#include "files/atomic_file.h"
#include "files/camera_info.h"
#include "files/frame_input.h"
#include "files/image_file.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "vision/features/simd_target.h"

namespace heel::cli {
namespace {

constexpr int kDefaultFrames = 60;
constexpr int kFarShirtFrames = 12;  // at most: each is large
constexpr int kLeastSide_px = 240, kMostSide_px = 2160;
constexpr double kImageRate_Hz = 30.0;

struct BenchVisionOptions {
  std::vector<std::string> inputs;
  std::string template_file;
  std::string camera_file;
  std::string size;
  int frames = kDefaultFrames;
  std::string simd;
  bool json = false;
  std::string picture;
};

void choose_simd(const std::string& name) {
  if (name.empty() || use_simd_target(name)) return;
  std::string expected;
  for (const std::string_view target : available_simd_targets())
    expected += (expected.empty() ? "" : ", ") + std::string(target);
  throw Error("--simd: '" + name + "' (expected one this processor has and heel is built for: " + expected +
              ")");
}

cv::Size parse_size(const std::string& text) {
  int width = 0, height = 0;
  char rest = 0;
  const bool whole = std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) == 2;
  if (!whole || width < kLeastSide_px || height < kLeastSide_px || width > 2 * kMostSide_px ||
      height > kMostSide_px || width < height)
    throw Error("--size: '" + text + "' (expected WxH, from 240x240 to 4320x2160, not higher than wide)");
  return {width, height};
}

/// The first `frames` + 1 of somebody's own pictures.
evaluation::BenchInput own_input(const BenchVisionOptions& options) {
  if (options.template_file.empty() || options.camera_file.empty())
    throw Error(std::string(options.template_file.empty() ? "--template" : "--camera-info") +
                ": missing (expected with an input)");
  evaluation::BenchInput input;
  input.shirt = read_template(options.template_file);
  input.camera = read_camera_model(options.camera_file);
  input.source = options.inputs.front();
  FrameInput frames(options.inputs, kImageRate_Hz);
  InputFrame frame;
  while (input.frames.size() <= static_cast<std::size_t>(options.frames) && frames.next(frame)) {
    require_size(frame, input.camera, options.camera_file);
    input.frames.push_back({frame.grey.clone(), ns_from_seconds(frame.t_s)});
  }
  for (const std::string& problem : frames.problems())
    std::fprintf(stderr, "heel bench vision: %s\n", problem.c_str());
  return input;
}

evaluation::BenchInput input_of(const BenchVisionOptions& options) {
  if (!options.inputs.empty()) {
    if (!options.size.empty()) throw Error("--size: given with an input (expected one of the two)");
    return own_input(options);
  }
  for (const auto& [name, value] :
       {std::pair{"--template", options.template_file}, std::pair{"--camera-info", options.camera_file}})
    if (!value.empty())
      throw Error(std::string(name) + ": given without an input (expected images or a video)");
  const cv::Size size = parse_size(options.size.empty() ? "640x480" : options.size);
  return evaluation::walk_in_a_room(size, options.frames + 1);
}

/// P.png of the numbers in P.json.
void draw(const nlohmann::ordered_json& json, const std::string& picture) {
  const std::string numbers = std::filesystem::path(picture).replace_extension(".json").string();
  write_file_atomically(numbers, json.dump(2) + "\n");
  if (const std::string why_not = evaluation::draw_figures({numbers, picture}); !why_not.empty())
    throw Error(why_not);
}

void run_bench_vision(const BenchVisionOptions& options) {
  if (!options.picture.empty()) require_writable_image_name(options.picture);
  choose_simd(options.simd);
  const evaluation::BenchInput input = input_of(options);
  evaluation::VisionReport report;
  report.machine = evaluation::this_machine();
  report.source = input.source;
  report.frames = input.frames.empty() ? 0 : input.frames.size() - 1;
  report.size = {input.camera.width_px, input.camera.height_px};
  // Only with the built-in pictures.
  std::optional<evaluation::BenchInput> far_shirt;
  if (options.inputs.empty() && options.size.empty())
    far_shirt = evaluation::far_shirt_in_a_room(std::min(options.frames, kFarShirtFrames) + 1);
  commandline::Progress progress("frame", report.frames);
  report.bench = evaluation::measure_vision(input, far_shirt ? &*far_shirt : nullptr,
                                            [&](std::size_t frame) { progress.show(frame); });
  progress.clear();
  std::cout << (options.json ? evaluation::to_json(report).dump(2) + "\n" : evaluation::table(report));
  if (!options.picture.empty()) draw(evaluation::to_json(report), options.picture);
}

}  // namespace

void add_bench_vision_command(CLI::App& bench) {
  auto options = std::make_shared<BenchVisionOptions>();
  CLI::App* command = bench.add_subcommand(
      "vision",
      "Each stage of vision, a frame searched everywhere and one tracked, beside cv::ORB, AKAZE, SIFT,\n"
      "BFMatcher, findHomography and decomposeHomographyMat: thread CPU time, all in turns on every frame.\n"
      "Ratios are of medians; goals hold at 640x480. Without an input and a size, also searching in "
      "1920x1080\n"
      "for a shirt of 85 pixels, beside cv::ORB(3000). The exit status is 0 even if a goal is missed.");
  command
      ->add_option("inputs", options->inputs,
                   "images, folders of images, videos to measure on (default: a person's walk through a\n"
                   "simulated room)")
      ->type_name("INPUT");
  command->add_option("--template", options->template_file, "with an input: template file")
      ->type_name("T.heel");
  command->add_option("--camera-info", options->camera_file, "with an input: the camera that took it")
      ->type_name("CAM.yaml");
  command->add_option("--frames", options->frames, "frames measured, after one for warming up")
      ->type_name("N")
      ->check(CLI::Range(1, evaluation::kMaxWorldFrames))
      ->capture_default_str();
  command->add_option("--size", options->size, "of the simulated pictures (default 640x480)")
      ->type_name("WxH");
  command
      ->add_option("--simd", options->simd,
                   "instruction set heel's vision runs with (default: the best this processor has)")
      ->type_name("NAME");
  command->add_flag("--json", options->json, "one JSON object (default: a table)");
  command
      ->add_option("--picture", options->picture,
                   "draw the times as bars: P.png and P.svg from P.json, which needs\n"
                   "the Debian package python3-matplotlib")
      ->type_name("P.png");
  command->callback([options] { run_bench_vision(*options); });
}

}  // namespace heel::cli
