// heel fit: the pose-noise model, which simulates vision without rendering, fitted to vision on rendered
// pictures.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "commandline/progress.h"
#include "commands.h"
#include "evaluation/experiments/run_record.h"
#include "evaluation/experiments/still_image_cases.h"
#include "evaluation/experiments/still_image_file.h"
#include "evaluation/reports/fit_rows.h"
#include "evaluation/reports/run_files.h"
#include "files/folder.h"
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
  bool json = false;
};

/// Makes DIR/errors.csv: the standing person in thousands of poses.
void make_stills(const sim::Scenario& base, const VisionConfig& vision, const FitOptions& options,
                 const std::string& file) {
  const auto& known = evaluation::still_image_experiments();
  const auto errors = std::find_if(known.begin(), known.end(),
                                   [](const auto& one) { return std::string(one.name) == "errors"; });
  commandline::Progress progress("poses");
  evaluation::write_still_images(
      evaluation::run_still_images(base, errors->cases(options.thousands), options.teach_distance_m, vision,
                                   {}, [&](std::size_t done, std::size_t of) { progress.show(done, of); }),
      file);
}

/// Makes DIR/runs/walk: how errors are correlated from frame to frame.
void make_walk(sim::LockstepSettings settings, const FitOptions& options, const std::string& directory) {
  settings.scenario.duration_s = std::min(settings.scenario.duration_s, options.walk_s);
  settings.shirt = sim::teach_from_world(settings.scenario, options.teach_distance_m);
  make_folder(directory);
  evaluation::RunRecord record(directory, settings);
  sim::run_lockstep(settings, record);
}

void run_fit(const FitOptions& options) {
  sim::LockstepSettings settings;
  settings.scenario = sim::read_scenario(options.walk);
  sim::apply_scenario(settings.scenario, settings.config);
  const std::string stills = options.directory + "/errors.csv", walk = options.directory + "/runs/walk";
  make_folder(options.directory);
  if (!std::filesystem::exists(stills))
    make_stills(settings.scenario, settings.config.vision, options, stills);
  if (!std::filesystem::exists(walk + "/truth.csv")) make_walk(settings, options, walk);

  const CameraModel& camera = settings.scenario.camera.model;
  const auto rows = evaluation::still_fit_rows(evaluation::read_stills(stills), camera);
  const auto frames = evaluation::walk_fit_rows(evaluation::read_run(walk), camera);
  const sim::ErrorModel model = sim::fit_error_model(rows, frames);
  const auto found = std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.found; });
  const std::string note =
      fmt::format("Fitted to {} pictures of the standing person, found in {}, and {} frames of {}.",
                  rows.size(), found, frames.size(), settings.scenario.name);
  sim::write_error_model(model, note, options.out);
  if (options.json) {
    const nlohmann::ordered_json json{{"model", options.out},
                                      {"pictures", rows.size()},
                                      {"found", found},
                                      {"frames", frames.size()},
                                      {"scenario", settings.scenario.name}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print("{}\n{}\n", note, options.out);
}

}  // namespace

void add_fit_command(CLI::App& app) {
  auto options = std::make_shared<FitOptions>();
  CLI::App* command = app.add_subcommand(
      "fit", "Fits the pose-noise model, for simulation without rendering, to vision on rendered pictures");
  command
      ->add_option(
          "directory", options->directory,
          "folder with errors.csv (`heel experiment errors`) and runs/walk (`heel simulate --out`); missing "
          "ones are made first")
      ->required()
      ->type_name("DIR");
  command->add_option("-o,--out", options->out, "the model (TOML), for `heel simulate --error-model`")
      ->required()
      ->type_name("MODEL.toml");
  command
      ->add_option("--walk", options->walk,
                   "the walk's scenario; its camera, person and light are used for all pictures")
      ->required()
      ->type_name("SCENARIO");
  command
      ->add_option("--walk-duration", options->walk_s,
                   "longest duration of that walk when it is made, seconds")
      ->check(CLI::Range(10.0, 600.0))
      ->capture_default_str();
  command->add_option("--thousands", options->thousands, "thousands of poses when errors.csv is made")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--teach-distance", options->teach_distance_m, "of the reference view, metres")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object (default: text)");
  command->callback([options] { run_fit(*options); });
}

}  // namespace heel::cli
