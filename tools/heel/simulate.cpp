// heel simulate: scenarios through the daemon's own stages in lock step, and how well the person was
// followed.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "commands.h"
#include "heel/error.h"
#include "simulate_options.h"
#include "simulate_runs.h"

namespace heel::cli {
namespace {

bool is_folder_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
}

/// Scenarios whose names are different and can be the names of folders.
std::vector<sim::Scenario> named_scenarios(const SimulateOptions& options,
                                           const std::vector<std::string>& files) {
  std::vector<sim::Scenario> scenarios;
  std::set<std::string> names;
  for (const std::string& file : files) {
    scenarios.push_back(scenario_of(options, file));
    const std::string& name = scenarios.back().name;
    if (!is_folder_name(name))
      throw Error(fmt::format("{}: name: '{}' cannot name a folder (expected letters, digits, '-' and '_')",
                              file, name));
    if (!names.insert(name).second)
      throw Error(
          fmt::format("{}: name: a second scenario called '{}' (expected different names)", file, name));
  }
  return scenarios;
}

void run_simulate(const SimulateOptions& options) {
  if (options.runs > 1) {
    if (!options.out.empty()) throw Error("--out: given beside --runs (expected one or the other)");
    if (options.scenarios.size() != 1) throw Error("--runs: several scenarios (expected one)");
    simulate_many(options, scenario_of(options, options.scenarios.front()));
    return;
  }
  const std::vector<std::string> files = scenario_files(options.scenarios);
  if (files.size() == 1 && files == options.scenarios) {
    simulate_one(options, scenario_of(options, files.front()));
  } else {
    simulate_several(options, named_scenarios(options, files));
  }
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command =
      app.add_subcommand("simulate",
                         "Runs scenarios in lock step with the simulated world. One scenario is reported in\n"
                         "detail, several as a table and figures. Exit status 1 when a limit is not met.");
  command->add_option("scenario", options->scenarios, "scenario files (TOML), or folders of them")
      ->required()
      ->type_name("SCENARIO");
  command->add_option("--seed", options->seed, "replaces the scenario's")
      ->check(whole_number("a whole number"));
  command->add_option("--duration", options->duration_s, "seconds; replaces the scenario's")
      ->check(duration_s());
  command
      ->add_option("--config", options->config_file,
                   "the daemon's configuration file (default: every key at its default)")
      ->type_name("FILE");
  command
      ->add_option("--template", options->template_file,
                   "template file (default: made from the world's reference view)")
      ->type_name("T.heel");
  command
      ->add_option(
          "--error-model", options->error_model_file,
          "do not draw pictures: take poses from this error model (`heel fit`), some hundred times faster")
      ->type_name("MODEL.toml");
  command->add_option("--teach-distance", options->teach_distance_m, "of the reference view, metres")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  command
      ->add_option(
          "-o,--out", options->out,
          std::string("folder for the recording run.mcap, truth.csv, wire.hex and frames; with several "
                      "scenarios it has a folder for each (default ") +
              kSimulateDefaultOut + ")")
      ->type_name("DIR");
  command->add_flag("--json", options->json, "metrics as JSON; of several scenarios as a list");
  command
      ->add_option("--runs", options->runs,
                   "this many runs of one scenario with consecutive seeds, and statistics over them")
      ->check(CLI::Range(1, 100000));
  add_criteria_options(*command, options->criteria);
  command->callback([options] { run_simulate(*options); });
}

}  // namespace heel::cli
