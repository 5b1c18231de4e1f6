// heel simulate: scenarios through the daemon's own stages in lock step, and how well they were followed.
#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <future>
#include <iostream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "commands.h"
#include "config/config_load.h"
#include "evaluation/experiments/many_runs.h"
#include "evaluation/experiments/run_record.h"
#include "evaluation/metrics/metrics.h"
#include "evaluation/reports/plots.h"
#include "evaluation/reports/run_report.h"
#include "files/atomic_file.h"
#include "files/template_file.h"
#include "heel/error.h"
#include "sim/lockstep/lockstep.h"
#include "simulate_runs.h"

namespace heel::cli {
namespace {

constexpr const char* kDefaultOut = "out/simulate";

struct SimulateOptions {
  std::vector<std::string> scenarios;
  std::string config_file;
  std::string template_file;
  std::string error_model;
  std::string out;
  double teach_distance_m = 1.5;
  long long seed = -1;
  double duration_s = 0.0;
  int runs = 1;
  bool json = false;
  evaluation::FollowCriteria criteria;
};

sim::Scenario scenario_of(const SimulateOptions& options, const std::string& file) {
  sim::Scenario scenario = sim::read_scenario(file);
  if (options.seed >= 0) scenario.seed = static_cast<std::uint64_t>(options.seed);
  if (options.duration_s > 0.0) scenario.duration_s = options.duration_s;
  return scenario;
}

sim::LockstepSettings settings_of(const SimulateOptions& options, const sim::Scenario& scenario) {
  sim::LockstepSettings settings;
  settings.scenario = scenario;
  if (!options.config_file.empty()) settings.config = load_config(options.config_file).config;
  sim::apply_scenario(settings.scenario, settings.config);
  if (!options.error_model.empty()) {
    settings.errors = sim::read_error_model(options.error_model);
    settings.shirt.distance_m = options.teach_distance_m;
  } else if (!options.template_file.empty())
    settings.shirt = read_template(options.template_file);
  else if (settings.scenario.camera.source == "sim")
    settings.shirt = sim::teach_from_world(settings.scenario, options.teach_distance_m);
  else
    throw Error("--template: missing (expected a template for frames from " +
                settings.scenario.camera.source + ")");
  return settings;
}

bool is_folder_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
}

SimulatedRun description_of(const sim::Scenario& scenario) {
  SimulatedRun run;
  run.scenario = scenario.name;
  run.shows = scenario.shows;
  run.seed = scenario.seed;
  return run;
}

/// Runs in lock step; the record keeps what the figures need.
SimulatedRun simulated(const SimulateOptions& options, const sim::LockstepSettings& settings,
                       evaluation::RunRecord& record) {
  SimulatedRun run = description_of(settings.scenario);
  const auto begin = std::chrono::steady_clock::now();
  run.counts = sim::run_lockstep(settings, record);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  run.times_real = settings.scenario.duration_s / took_s;
  run.metrics = record.metrics().evaluate();
  run.failed = evaluation::failed_criteria(run.metrics, options.criteria);
  return run;
}

bool report_failed(const std::vector<SimulatedRun>& runs) {
  bool any = false;
  for (const SimulatedRun& run : runs)
    for (const std::string& reason : run.failed) {
      std::cerr << "heel simulate: " << (runs.size() > 1 ? run.scenario + ": " : "") << reason << '\n';
      any = true;
    }
  return any;
}

void run_one(const SimulateOptions& options, const sim::Scenario& scenario) {
  const sim::LockstepSettings settings = settings_of(options, scenario);
  evaluation::RunRecord record(options.out, settings);
  const SimulatedRun run = simulated(options, settings, record);
  std::cout << (options.json ? to_json(run).dump(2) + "\n" : detailed_text(run));
  if (report_failed({run})) throw CLI::RuntimeError(kExitNo);
}

/// What the runs came to, and what each scenario shows: overview.png is drawn from it.
void write_overview(const std::vector<SimulatedRun>& runs, const std::string& out) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const SimulatedRun& run : runs) {
    all.push_back(to_json(run));
    all.back()["shows"] = run.shows;
  }
  write_file_atomically(out + "/overview.json", all.dump(2) + "\n");
}

/// All of them, each into a folder of its own under `out`; a shirt that cannot be followed is a result too.
void run_several(const SimulateOptions& options, const std::vector<sim::Scenario>& scenarios) {
  const std::string out = options.out.empty() ? kDefaultOut : options.out;
  std::vector<SimulatedRun> runs;
  for (const sim::Scenario& scenario : scenarios) {
    const std::string folder = out + "/" + scenario.name;
    std::filesystem::remove_all(folder + "/frames");  // of an earlier run
    if (!options.json) std::cerr << scenario.name << ": " << scenario.shows << '\n';
    sim::LockstepSettings settings;
    try {
      settings = settings_of(options, scenario);
    } catch (const Error& error) {
      runs.push_back(description_of(scenario));
      runs.back().refused = error.what();
      continue;
    }
    evaluation::RunRecord record(folder, settings);
    runs.push_back(simulated(options, settings, record));
    record.flush();
    evaluation::write_run_report(folder, record.metrics(), runs.back().metrics, runs.back().failed);
  }
  const std::string table = table_text(runs);
  std::filesystem::create_directories(out);
  write_file_atomically(out + "/table.txt", table);
  write_overview(runs, out);
  if (options.json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const SimulatedRun& run : runs) all.push_back(to_json(run));
    std::cout << all.dump(2) << '\n';
  } else {
    std::cout << table << "pictures and recordings: " << out << '\n';
  }
  std::cout << std::flush;
  if (const std::string why_not = evaluation::draw_figures({out}); !why_not.empty())
    std::cerr << "heel simulate: " << why_not << '\n';
  if (report_failed(runs)) throw CLI::RuntimeError(kExitNo);
}

evaluation::FollowMetrics run_seed(const SimulateOptions& options, sim::Scenario scenario, int later) {
  scenario.seed += static_cast<std::uint64_t>(later);
  const sim::LockstepSettings settings = settings_of(options, scenario);
  evaluation::RunRecord record("", settings);
  sim::run_lockstep(settings, record);
  return record.metrics().evaluate();
}

/// From the scenario's seed (or the given one) on. Without pictures, whose rows the cores share already, one
/// run a core at a time.
void run_many(const SimulateOptions& options) {
  if (!options.out.empty()) throw Error("--out: given beside --runs (expected one or the other)");
  if (options.scenarios.size() != 1) throw Error("--runs: several scenarios (expected one)");
  const sim::Scenario scenario = scenario_of(options, options.scenarios.front());
  evaluation::ManyRuns many;
  const auto begin = std::chrono::steady_clock::now();
  many.runs.resize(static_cast<std::size_t>(options.runs));
  many.simulated_s = options.runs * settings_of(options, scenario).scenario.duration_s;
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int i = next++; i < options.runs; i = next++)
      many.runs[static_cast<std::size_t>(i)] = run_seed(options, scenario, i);
  };
  const unsigned at_once =
      options.error_model.empty() ? 1 : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < at_once; ++i) workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) worker.get();
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (options.json) {
    std::cout << evaluation::to_json(many).dump(2) << '\n';
    return;
  }
  std::cout << evaluation::many_runs_table(many);
  std::printf("%zu runs, %.0f s simulated, %.0f x real time\n", many.runs.size(), many.simulated_s,
              many.simulated_s / took_s);
}

void run_simulate(const SimulateOptions& options) {
  if (options.runs > 1) {
    run_many(options);
    return;
  }
  const std::vector<std::string> files = scenario_files(options.scenarios);
  if (files.size() == 1 && files == options.scenarios) {
    run_one(options, scenario_of(options, files.front()));
    return;
  }
  std::vector<sim::Scenario> scenarios;
  std::set<std::string> names;
  for (const std::string& file : files) {
    scenarios.push_back(scenario_of(options, file));
    if (!is_folder_name(scenarios.back().name))
      throw Error(file + ": name: '" + scenarios.back().name +
                  "' cannot name a folder (expected letters, digits, '-' and '_')");
    if (!names.insert(scenarios.back().name).second)
      throw Error(file + ": name: a second scenario called '" + scenarios.back().name +
                  "' (expected names of their own)");
  }
  run_several(options, scenarios);
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand("simulate",
                                         "Runs scenarios in lock step with the simulated world; exit status "
                                         "1 when a limit is not met. Of several "
                                         "it prints a table and leaves pictures");
  command->add_option("scenario", options->scenarios, "scenario files (TOML), or folders of them")
      ->required();
  command->add_option("--seed", options->seed, "instead of the scenario's")->check(CLI::NonNegativeNumber);
  command->add_option("--duration", options->duration_s, "seconds, instead of the scenario's")
      ->check(CLI::PositiveNumber);
  command->add_option("--config", options->config_file, "the daemon's configuration (default: its defaults)");
  command->add_option("--template", options->template_file,
                      "template file (default: taught from the world's reference view)");
  command->add_option(
      "--error-model", options->error_model,
      "draw poses from this model (`heel fit`) instead of pictures, some hundred times faster");
  command->add_option("--teach-distance", options->teach_distance_m, "of that view, metres")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  command->add_option("-o,--out", options->out,
                      "folder for truth.csv, ticks.csv, poses.csv, wire.hex and frames; of several scenarios "
                      "each has a folder in it, default " +
                          std::string(kDefaultOut));
  command->add_flag("--json", options->json, "metrics as JSON; of several scenarios as a list");
  command->add_option("--runs", options->runs, "of one scenario, this many seeds in a row; what they come to")
      ->check(CLI::Range(1, 100000));
  command->add_option("--max-out-of-view-s", options->criteria.max_out_of_view_s, "fail when longer");
  command->add_option("--max-rms-m", options->criteria.max_rms_m, "fail when the paths lie farther apart");
  command->add_option("--min-path-m", options->criteria.min_robot_path_m,
                      "fail when the robot goes less far");
  command->callback([options] { run_simulate(*options); });
}

}  // namespace heel::cli
