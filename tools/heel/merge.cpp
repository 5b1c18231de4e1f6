// heel merge: the results of many runs, each of a process of its own, as statistics over all of them.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "commands.h"
#include "evaluation/metrics/samples.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

using MergeJson = nlohmann::ordered_json;

struct MergeOptions {
  std::vector<std::string> files;
  bool json = false;
};

/// The runs of one scenario.
struct MergedScenario {
  std::vector<std::uint64_t> seeds;
  std::vector<std::uint64_t> failed;  ///< seeds of the runs that have not met a limit
  std::vector<std::string> names;     ///< of the figures, in the order of the first run
  std::map<std::string, std::vector<double>> values;
};

/// "lateral_m.rms": every number of a run, with the names on the way to it. Lists have no name for each of
/// their numbers.
void collect(const MergeJson& json, const std::string& name, MergedScenario& scenario) {
  if (json.is_object()) {
    for (const auto& [field, inner] : json.items())
      if (!name.empty() || (field != "seed" && field != "scenario"))
        collect(inner, name.empty() ? field : name + "." + field, scenario);
    return;
  }
  if (!json.is_number() && !json.is_boolean()) return;
  std::vector<double>& values = scenario.values[name];
  if (values.empty()) scenario.names.push_back(name);
  values.push_back(json.is_boolean() ? (json.get<bool>() ? 1.0 : 0.0) : json.get<double>());
}

void add_run(const MergeJson& run, const std::string& file, std::map<std::string, MergedScenario>& all) {
  if (!run.is_object() || !run.value("scenario", MergeJson()).is_string() ||
      !run.value("seed", MergeJson()).is_number_unsigned())
    throw Error(file +
                ": no result of a run (expected what `heel simulate SCENARIO --seed N --json` prints)");
  const std::string name = run["scenario"].get<std::string>();
  const auto seed = run["seed"].get<std::uint64_t>();
  if (run.contains("refused"))
    throw Error(fmt::format("{}: the run of seed {} was refused: {}", file, seed, run["refused"].dump()));
  MergedScenario& scenario = all[name];
  if (std::find(scenario.seeds.begin(), scenario.seeds.end(), seed) != scenario.seeds.end())
    throw Error(
        fmt::format("{}: seed {} of {} a second time (expected each run once; is a file given twice?)", file,
                    seed, name));
  scenario.seeds.push_back(seed);
  if (run.contains("failed") && !run["failed"].empty()) scenario.failed.push_back(seed);
  collect(run, "", scenario);
}

/// One run, a list of runs, or several of both one after the other, as GNU parallel prints them.
void add_file(const std::string& file, std::map<std::string, MergedScenario>& all) {
  std::ifstream in(file);
  if (!in) throw Error(file + ": cannot be read (expected a file with results of heel simulate --json)");
  std::size_t runs = 0;
  while (in >> std::ws && in.peek() != std::ifstream::traits_type::eof()) {
    MergeJson json;
    try {
      in >> json;
    } catch (const MergeJson::exception&) {
      throw Error(
          fmt::format("{}: not JSON after {} runs (expected results of heel simulate --json; was a run "
                      "interrupted?)",
                      file, runs));
    }
    if (!json.is_array()) json = MergeJson::array({json});
    for (const MergeJson& run : json) {
      add_run(run, file, all);
      ++runs;
    }
  }
  if (runs == 0)
    throw Error(file + ": no run in it (expected results of heel simulate --json; has the run ended?)");
}

MergeJson json_of(const MergedScenario& scenario, const std::string& name) {
  MergeJson json{{"scenario", name},
                 {"runs", scenario.seeds.size()},
                 {"seeds", scenario.seeds},
                 {"failed", scenario.failed},
                 {"figures", MergeJson::object()}};
  for (const std::string& figure : scenario.names) {
    const evaluation::Quantiles q = evaluation::quantiles(scenario.values.at(figure));
    json["figures"][figure] = {{"runs", q.count}, {"mean", q.mean},  {"deviation", q.deviation},
                               {"min", q.lowest}, {"p05", q.p05},    {"p50", q.p50},
                               {"p95", q.p95},    {"max", q.highest}};
  }
  return json;
}

std::string table_of(const MergedScenario& scenario, const std::string& name) {
  std::string text = fmt::format(
      "{}: {} runs, {} of them did not meet a limit\n{:<36} {:>6} {:>10} {:>10} {:>10} "
      "{:>10} {:>10}\n",
      name, scenario.seeds.size(), scenario.failed.size(), "", "runs", "mean", "deviation", "least", "median",
      "most");
  for (const std::string& figure : scenario.names) {
    const evaluation::Quantiles q = evaluation::quantiles(scenario.values.at(figure));
    text += fmt::format("{:<36} {:>6} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g} {:>10.4g}\n", figure, q.count,
                        q.mean, q.deviation, q.lowest, q.p50, q.highest);
  }
  return text;
}

void run_merge(const MergeOptions& options) {
  std::map<std::string, MergedScenario> all;
  for (const std::string& file : options.files) add_file(file, all);
  MergeJson json{{"scenarios", MergeJson::array()}};
  bool all_met = true;
  for (auto& [name, scenario] : all) {
    std::sort(scenario.seeds.begin(), scenario.seeds.end());
    std::sort(scenario.failed.begin(), scenario.failed.end());
    all_met = all_met && scenario.failed.empty();
    if (options.json)
      json["scenarios"].push_back(json_of(scenario, name));
    else
      std::cout << table_of(scenario, name);
  }
  if (options.json) std::cout << json.dump(2) << '\n';
  if (!all_met) throw CLI::RuntimeError(kExitNo);
}

}  // namespace

void add_merge_command(CLI::App& app) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand(
      "merge",
      "Statistics over runs that were simulated by many processes, on one machine or many: for each scenario "
      "and\n"
      "figure the mean, deviation and quantiles over the runs. The order of the files does not matter.");
  command
      ->add_option("files", options->files,
                   "results of `heel simulate SCENARIO --seed N --json`, one or several in a file")
      ->required()
      ->type_name("RUN.json");
  command->add_flag("--json", options->json, "one JSON object with a list `scenarios` (default: tables)");
  command->callback([options] { run_merge(*options); });
}

}  // namespace heel::cli
