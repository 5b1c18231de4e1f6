// heel experiment: the paper's experiments, and more, on the pictured world; rows for heel report.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "config/config_load.h"
#include "evaluation/experiments/real_images.h"
#include "evaluation/experiments/still_cases.h"
#include "evaluation/experiments/still_file.h"
#include "heel/error.h"
#include "sim/lockstep/lockstep.h"

namespace heel::cli {
namespace {

constexpr const char* kReal = "real";
constexpr int kVideoStep = 3;  ///< ten frames a second are enough to see certainty rise and fall

struct ExperimentOptions {
  std::vector<std::string> names;
  std::string out;
  std::string scenario;
  std::string config_file;
  double teach_distance_m = 1.5;
  int repeats = 0;
  std::string data;
};

sim::Scenario base_of(const ExperimentOptions& options) {
  if (!options.scenario.empty()) return sim::read_scenario(options.scenario);
  sim::Scenario scenario;
  scenario.camera.model = sim::default_camera_model();
  return scenario;
}

void run_still_experiment(const evaluation::StillExperiment& chosen, const ExperimentOptions& options) {
  const sim::Scenario base = base_of(options);
  Config config;
  if (!options.config_file.empty()) config = load_config(options.config_file).config;
  sim::apply_scenario(base, config);
  const std::string pictures = options.out + "/" + chosen.name;
  if (chosen.keeps_pictures) std::filesystem::create_directories(pictures);
  const auto keep = [&](const evaluation::StillRow&, std::size_t index,
                        const std::vector<std::uint8_t>& grey) {
    char name[32];
    std::snprintf(name, sizeof name, "/%03zu.png", index);
    // OpenCV wants a mutable pointer; it only reads.
    const cv::Mat picture(base.camera.model.height_px, base.camera.model.width_px, CV_8U,
                          const_cast<std::uint8_t*>(grey.data()));
    if (chosen.keeps_pictures && !cv::imwrite(pictures + name, picture))
      throw Error(pictures + name + ": cannot write (expected a writable folder)");
  };
  const auto progress = [&](std::size_t done, std::size_t of) {
    std::fprintf(stderr, "\r%-10s %5zu of %zu poses", chosen.name, done, of);
  };
  const auto rows =
      evaluation::run_stills(base, chosen.cases(options.repeats > 0 ? options.repeats : chosen.repeats),
                             options.teach_distance_m, config.vision, keep, progress);
  const auto found =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.pose.found(); });
  const std::string file = options.out + "/" + chosen.name + ".csv";
  evaluation::write_stills(rows, file);
  std::fprintf(stderr, "\r");
  std::printf("%-10s %zu pictures, found in %td: %s\n", chosen.name, rows.size(), found, file.c_str());
  std::fflush(stdout);
}

/// HEEL_TEST_DATA, where no folder is named.
std::string data_folder(const ExperimentOptions& options) {
  if (!options.data.empty()) return options.data;
  const char* given = std::getenv("HEEL_TEST_DATA");
  return given != nullptr ? given : "../shared/data";
}

void look_at_real_images(const ExperimentOptions& options) {
  const std::string data = data_folder(options);
  const VisionConfig vision;
  const auto pairs = evaluation::look_at_pairs(data, vision);
  if (!pairs.empty()) evaluation::write_pairs(pairs, options.out + "/real_pairs.csv");
  const auto video = evaluation::look_at_video(data, kVideoStep, vision);
  if (!video.empty()) evaluation::write_video(video, options.out + "/real_video.csv");
  std::printf("%-10s %zu pairs, %zu frames of video%s\n", kReal, pairs.size(), video.size(),
              pairs.empty() || video.empty() ? (": SKIPPED where absent in " + data).c_str() : "");
  std::fflush(stdout);
}

void run_experiments(const ExperimentOptions& options) {
  std::filesystem::create_directories(options.out);
  if (std::find(options.names.begin(), options.names.end(), kReal) != options.names.end())
    look_at_real_images(options);
  for (const evaluation::StillExperiment& known : evaluation::still_experiments())
    if (std::find(options.names.begin(), options.names.end(), known.name) != options.names.end())
      run_still_experiment(known, options);
}

}  // namespace

void add_experiment_command(CLI::App& app) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand(
      "experiment", "Looks at the pictured person in commanded poses; NAME.csv for `heel report`");
  std::vector<std::string> names;
  std::string help = "one or more of:";
  for (const evaluation::StillExperiment& known : evaluation::still_experiments()) {
    names.emplace_back(known.name);
    help += std::string("\n  ") + known.name + ": " + known.what;
  }
  names.emplace_back(kReal);
  help += std::string("\n  ") + kReal + ": homography error on real pairs, certainty over a real video";
  command->add_option("name", options->names, help)->required()->check(CLI::IsMember(names));
  command->add_option("-o,--out", options->out, "folder for the rows and pictures")->required();
  command
      ->add_option("--repeats", options->repeats,
                   "of each pose, over up to eight worlds; errors: thousands of poses")
      ->check(CLI::Range(1, 1000));
  command->add_option("--data", options->data,
                      "folder of the real pictures (default: HEEL_TEST_DATA, else ../shared/data)");
  command->add_option("--scenario", options->scenario,
                      "its camera, light and person (default: the simulator's own)");
  command->add_option("--config", options->config_file, "the daemon's configuration (default: its defaults)");
  command->add_option("--teach-distance", options->teach_distance_m, "of the template's view, metres")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  command->callback([options] { run_experiments(*options); });
}

}  // namespace heel::cli
