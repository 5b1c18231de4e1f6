// heel tune: values of control keys that follow better, by search in the simulated world without pictures.
#include <fmt/format.h>

#include <csignal>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commandline/progress.h"
#include "commands.h"
#include "config/config_block.h"
#include "config/config_load.h"
#include "evaluation/reports/plots.h"
#include "files/atomic_file.h"
#include "files/image_file.h"
#include "heel/error.h"
#include "simulate_options.h"
#include "toml/toml_file.h"
#include "tune_report.h"

namespace heel::cli {
namespace {

constexpr std::uint64_t kAside = 1000;  // seeds that judge begin so much higher than those of the search
constexpr double kNotAllowed = 1e6;     // cost of values that no configuration may have

struct TuneOptions {
  SimulateOptions simulate;  ///< scenarios, configuration, error model
  std::vector<std::string> keys;
  double factor = 3.0;
  int seeds = 3;
  std::uint64_t first_seed = 1;
  int steps = 80;
  std::string out, picture;
  bool json = false;
};

volatile std::sig_atomic_t g_interrupted = 0;

/// The first SIGINT ends the search; a second one ends the program, which has written nothing.
void end_search_on_sigint() {
  struct sigaction action {};
  action.sa_handler = [](int) { g_interrupted = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
}

/// Three digits are enough for a gain, and a person can read them.
std::vector<double> rounded(std::vector<double> values) {
  for (double& value : values) value = std::stod(fmt::format("{:.3g}", value));
  return values;
}

evaluation::TuningRuns runs_of(const TuneOptions& options) {
  evaluation::TuningRuns runs;
  for (const std::string& file : scenario_files(options.simulate.scenarios))
    runs.scenarios.push_back(settings_of(options.simulate, scenario_of(options.simulate, file)));
  runs.first_seed = options.first_seed;
  runs.seeds = options.seeds;
  return runs;
}

TuneReport tune(const TuneOptions& options, const Config& config) {
  TuneReport report;
  report.law = config.control.law;
  report.keys = evaluation::tuned_keys(config, options.keys, options.factor);
  for (const auto& key : report.keys) report.before.push_back(evaluation::value_of(key, config));
  report.searched = report.aside = runs_of(options);
  report.aside.first_seed += kAside;

  end_search_on_sigint();
  commandline::Progress progress("steps", static_cast<std::uint64_t>(options.steps));
  const auto cost = [&](std::span<const double> values) {
    if (!evaluation::relations_hold(evaluation::with_values(config, report.keys, values))) return kNotAllowed;
    return evaluation::judge(report.searched, report.keys, values).cost;
  };
  std::uint64_t done = 0;
  const auto go_on = [&](const evaluation::SearchStep&) {
    progress.show(++done);
    return g_interrupted == 0;
  };
  report.steps = evaluation::search(report.keys, report.before, cost, options.steps, go_on);
  progress.clear();
  report.interrupted = g_interrupted != 0;
  report.after = rounded(evaluation::best_step(report.steps).values);
  report.aside_before = evaluation::judge(report.aside, report.keys, report.before);
  report.aside_after = evaluation::judge(report.aside, report.keys, report.after);
  return report;
}

/// `text` of the configuration with the values found.
std::string tuned_text(const TuneReport& report, const std::string& text, const std::string& file,
                       const Config& config) {
  const Config tuned = evaluation::with_values(config, report.keys, report.after);
  return config_text_with_block(text, file, changes_between(config, tuned), provenance_of(report));
}

void run_tune(const TuneOptions& options) {
  if (!options.picture.empty()) require_writable_image_name(options.picture);
  const std::string& file = options.simulate.config_file;
  const std::string text = file.empty() ? "" : read_toml_text(file, "a configuration of heeld");
  const Config config = file.empty() ? Config{} : parse_config(text, file).config;
  TuneReport report = tune(options, config);
  const bool better = report.better();

  if (options.json) {
    std::cout << to_json(report).dump(2) << '\n';
  } else {
    std::cout << text_of(report);
  }
  if (!options.picture.empty()) {
    const std::string numbers = std::filesystem::path(options.picture).replace_extension(".json").string();
    write_file_atomically(numbers, to_json(report).dump(2) + "\n");
    if (const std::string why_not = evaluation::draw_figures({numbers, options.picture}); !why_not.empty())
      std::cerr << "heel tune: " << why_not << '\n';
  }
  if (!better) {
    std::cerr << "heel tune: no better values found; nothing is written\n";
    throw CLI::RuntimeError(kExitNo);
  }
  if (!options.out.empty()) {
    write_file_atomically(options.out, tuned_text(report, text, file.empty() ? options.out : file, config));
    if (!options.json) std::cout << "written: " << options.out << '\n';
  }
}

}  // namespace

void add_tune_command(CLI::App& app) {
  auto options = std::make_shared<TuneOptions>();
  CLI::App* command = app.add_subcommand(
      "tune",
      "Seeks values of [control] with which the robot follows better, in lock step with sampled poses, and\n"
      "judges them with seeds that the search has not seen. Exit status 1 when none are better. Ctrl-C ends\n"
      "the search; what it has found so far is judged.");
  command->add_option("scenario", options->simulate.scenarios, "scenario files (TOML), or folders of them")
      ->required()
      ->type_name("SCENARIO");
  command->add_option("--error-model", options->simulate.error_model_file, "of vision's errors (`heel fit`)")
      ->required()
      ->type_name("MODEL.toml");
  command
      ->add_option("--config", options->simulate.config_file,
                   "the daemon's configuration file (default: every key at its default)")
      ->type_name("FILE");
  command
      ->add_option("--key", options->keys,
                   "a key to tune, as control.gain_yaw_1_s; may be repeated (default: those of the law)")
      ->type_name("KEY");
  command->add_option("--within", options->factor, "how many times smaller or larger a value may become")
      ->check(number_from(1.01, 100.0))
      ->capture_default_str();
  command->add_option("--runs", options->seeds, "runs of each scenario, with consecutive seeds")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--seed", options->first_seed, "the first seed")
      ->check(whole_number("a whole number"))
      ->capture_default_str();
  command->add_option("--steps", options->steps, "sets of values to try at most")
      ->check(CLI::Range(2, 100000))
      ->capture_default_str();
  command
      ->add_option("-o,--out", options->out,
                   "writes the configuration with the values in a block of their own; may be --config")
      ->type_name("FILE");
  command->add_option("--picture", options->picture, "draws cost and figures, before and after")
      ->type_name("PICTURE");
  command->add_flag("--json", options->json, "everything as JSON");
  command->callback([options] { run_tune(*options); });
}

}  // namespace heel::cli
