#include "simulate_options.h"

#include <algorithm>
#include <filesystem>

#include "config/config_load.h"
#include "files/template_file.h"
#include "heel/error.h"

namespace heel::cli {

std::vector<std::string> scenario_files(const std::vector<std::string>& arguments) {
  namespace fs = std::filesystem;
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    if (!fs::is_directory(argument)) {
      files.push_back(argument);
      continue;
    }
    std::vector<std::string> in_folder;
    for (const auto& entry : fs::directory_iterator(argument))
      if (entry.path().extension() == ".toml") in_folder.push_back(entry.path().string());
    if (in_folder.empty()) throw Error(argument + ": no scenario in this folder (expected *.toml)");
    std::sort(in_folder.begin(), in_folder.end());
    files.insert(files.end(), in_folder.begin(), in_folder.end());
  }
  return files;
}

sim::Scenario scenario_of(const SimulateOptions& options, const std::string& file) {
  sim::Scenario scenario = sim::read_scenario(file);
  if (options.seed) scenario.seed = *options.seed;
  if (options.duration_s > 0.0) scenario.duration_s = options.duration_s;
  return scenario;
}

sim::LockstepSettings settings_of(const SimulateOptions& options, const sim::Scenario& scenario) {
  sim::LockstepSettings settings;
  settings.scenario = scenario;
  if (!options.config_file.empty()) settings.config = load_config(options.config_file).config;
  sim::apply_scenario(settings.scenario, settings.config);
  if (options.error_model_file.empty())
    for (const std::string& file : settings.config.target.more_shirts)
      settings.more_shirts.push_back(read_template(file));
  if (!options.error_model_file.empty()) {
    settings.errors = sim::read_error_model(options.error_model_file);
    settings.shirt.distance_m = options.teach_distance_m;
  } else if (!options.template_file.empty()) {
    settings.shirt = read_template(options.template_file);
    if (settings.config.target.distance_m > 0.0)
      settings.shirt.distance_m = settings.config.target.distance_m;
  } else if (settings.scenario.camera.source == "sim") {
    settings.shirt = sim::teach_from_world(settings.scenario, options.teach_distance_m);
  } else {
    throw Error("--template: missing (expected a template for frames from " +
                settings.scenario.camera.source + ")");
  }
  return settings;
}

}  // namespace heel::cli
