// heel fit: the error model of the world without pictures, fitted to the pictured world.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

#include "commands.h"
#include "evaluation/experiments/run_record.h"
#include "evaluation/experiments/still_cases.h"
#include "evaluation/experiments/still_file.h"
#include "evaluation/reports/fit_rows.h"
#include "evaluation/reports/run_files.h"
#include "heel/error.h"
#include "sim/lockstep/lockstep.h"
#include "sim/pose_noise/error_fit.h"

namespace heel::cli {
namespace {

struct FitOptions {
  std::string directory;
  std::string out;
  std::string walk;
  double walk_s = 60.0;
  double teach_distance_m = 1.5;
  int thousands = 3;
};

/// DIR/errors.csv: the standing person in thousands of poses.
void make_stills(const sim::Scenario& base, const VisionConfig& vision, const FitOptions& options,
                 const std::string& file) {
  const auto& known = evaluation::still_experiments();
  const auto errors = std::find_if(known.begin(), known.end(),
                                   [](const auto& one) { return std::string(one.name) == "errors"; });
  evaluation::write_stills(
      evaluation::run_stills(
          base, errors->cases(options.thousands), options.teach_distance_m, vision, {},
          [](std::size_t done, std::size_t of) { std::fprintf(stderr, "\r%5zu of %zu poses", done, of); }),
      file);
  std::fprintf(stderr, "\r");
}

/// DIR/runs/walk: how long an error lasts from frame to frame.
void make_walk(sim::LockstepSettings settings, const FitOptions& options, const std::string& directory) {
  settings.scenario.duration_s = std::min(settings.scenario.duration_s, options.walk_s);
  settings.shirt = sim::teach_from_world(settings.scenario, options.teach_distance_m);
  std::filesystem::create_directories(directory);
  evaluation::RunRecord record(directory, settings);
  sim::run_lockstep(settings, record);
}

void run_fit(const FitOptions& options) {
  sim::LockstepSettings settings;
  settings.scenario = sim::read_scenario(options.walk);
  sim::apply_scenario(settings.scenario, settings.config);
  const std::string stills = options.directory + "/errors.csv", walk = options.directory + "/runs/walk";
  std::filesystem::create_directories(options.directory);
  if (!std::filesystem::exists(stills))
    make_stills(settings.scenario, settings.config.vision, options, stills);
  if (!std::filesystem::exists(walk + "/truth.csv")) make_walk(settings, options, walk);

  const CameraModel& camera = settings.scenario.camera.model;
  const auto rows = evaluation::still_fit_rows(evaluation::read_stills(stills), camera);
  const auto frames = evaluation::walk_fit_rows(evaluation::read_run(walk), camera);
  const sim::ErrorModel model = sim::fit_error_model(rows, frames);
  const auto found = std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.found; });
  char note[160];
  std::snprintf(note, sizeof note,
                "Fitted to %zu pictures of the standing person, found in %td, and %zu frames of %s.",
                rows.size(), found, frames.size(), settings.scenario.name.c_str());
  sim::write_error_model(model, note, options.out);
  std::printf("%s\n%s\n", note, options.out.c_str());
}

}  // namespace

void add_fit_command(CLI::App& app) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* command =
      app.add_subcommand("fit", "Fits the error model of the world without pictures to the pictured world");
  command
      ->add_option(
          "directory", options->directory,
          "holds errors.csv (`heel experiment errors`) and runs/walk (`heel simulate --out`); what is not "
          "there is made first")
      ->required();
  command->add_option("-o,--out", options->out, "the model (TOML), for `heel simulate --error-model`")
      ->required();
  command
      ->add_option("--walk", options->walk, "the walk's scenario; its camera, person and light are looked at")
      ->required();
  command->add_option("--walk-duration", options->walk_s, "of that walk where it is made, seconds at most")
      ->check(CLI::Range(10.0, 600.0))
      ->capture_default_str();
  command->add_option("--thousands", options->thousands, "thousands of poses looked at where they are made")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--teach-distance", options->teach_distance_m, "of the template's view, metres")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  command->callback([options] { run_fit(*options); });
}

}  // namespace heel::cli
