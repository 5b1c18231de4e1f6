#include "simulate_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <iostream>
#include <string>
#include <thread>

#include "commandline/progress.h"
#include "commands.h"
#include "evaluation/experiments/many_runs.h"
#include "evaluation/experiments/run_record.h"
#include "evaluation/reports/plots.h"
#include "evaluation/reports/run_report.h"
#include "files/atomic_file.h"
#include "files/folder.h"
#include "heel/error.h"
#include "simulate_output.h"

namespace heel::cli {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

SimulatedRun description_of(const sim::Scenario& scenario) {
  SimulatedRun run;
  run.scenario = scenario.name;
  run.shows = scenario.shows;
  run.seed = scenario.seed;
  return run;
}

/// A run's record that shows how far the run is.
class WatchedRecord final : public evaluation::RunRecord {
 public:
  WatchedRecord(const std::string& folder, const sim::LockstepSettings& settings)
      : RunRecord(folder, settings),
        progress_(settings.scenario.name + ", seconds",
                  static_cast<std::uint64_t>(std::ceil(settings.scenario.duration_s))) {}
  void on_tick(const TickRecord& tick, const sim::LockstepTruth& truth) override {
    RunRecord::on_tick(tick, truth);
    if (tick.tick == 0) begin_ns_ = tick.input.now_ns;
    progress_.show(static_cast<std::uint64_t>(seconds_from_ns(tick.input.now_ns - begin_ns_)));
  }
  void end_progress() { progress_.clear(); }

 private:
  commandline::Progress progress_;
  TimeNs begin_ns_ = 0;
};

SimulatedRun simulate(const SimulateOptions& options, const sim::LockstepSettings& settings,
                      WatchedRecord& record) {
  SimulatedRun run = description_of(settings.scenario);
  const Clock::time_point begin = Clock::now();
  run.counts = sim::run_lockstep(settings, record);
  record.end_progress();
  run.speed = settings.scenario.duration_s / seconds_since(begin);
  run.metrics = record.metrics().evaluate();
  run.failed = evaluation::failed_criteria(run.metrics, options.criteria);
  return run;
}

/// Prints the criteria that are not met; throws when there are any.
void require_criteria(const std::vector<SimulatedRun>& runs) {
  bool all_met = true;
  for (const SimulatedRun& run : runs)
    for (const std::string& reason : run.failed) {
      std::cerr << "heel simulate: " << (runs.size() > 1 ? run.scenario + ": " : "") << reason << '\n';
      all_met = false;
    }
  if (!all_met) throw CLI::RuntimeError(kExitNo);
}

/// overview.json: the results of the runs and what each scenario shows; overview.png is drawn from it.
void write_overview(const std::vector<SimulatedRun>& runs, const std::string& out) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const SimulatedRun& run : runs) {
    all.push_back(to_json(run));
    all.back()["shows"] = run.shows;
  }
  write_file_atomically(out + "/overview.json", all.dump(2) + "\n");
}

SimulatedRun simulate_into_folder(const SimulateOptions& options, const sim::Scenario& scenario,
                                  const std::string& folder) {
  std::filesystem::remove_all(folder + "/frames");  // of an earlier run
  sim::LockstepSettings settings;
  try {
    settings = settings_of(options, scenario);
  } catch (const Error& error) {
    SimulatedRun run = description_of(scenario);
    run.refused = error.what();
    return run;
  }
  WatchedRecord record(folder, settings);
  SimulatedRun run = simulate(options, settings, record);
  record.flush();
  evaluation::write_run_report(folder, record.metrics(), run.metrics, run.failed);
  return run;
}

evaluation::FollowMetrics simulate_seed(const SimulateOptions& options, sim::Scenario scenario,
                                        std::uint64_t seed) {
  scenario.seed = seed;
  const sim::LockstepSettings settings = settings_of(options, scenario);
  evaluation::RunRecord record("", settings);
  sim::run_lockstep(settings, record);
  return record.metrics().evaluate();
}

}  // namespace

void simulate_one(const SimulateOptions& options, const sim::Scenario& scenario) {
  const sim::LockstepSettings settings = settings_of(options, scenario);
  if (!options.out.empty()) make_folder(options.out);
  WatchedRecord record(options.out, settings);
  const SimulatedRun run = simulate(options, settings, record);
  record.flush();
  std::cout << (options.json ? to_json(run).dump(2) + "\n" : detailed_text(run));
  require_criteria({run});
}

void simulate_several(const SimulateOptions& options, const std::vector<sim::Scenario>& scenarios) {
  const std::string out = options.out.empty() ? kSimulateDefaultOut : options.out;
  make_folder(out);
  std::vector<SimulatedRun> runs;
  for (const sim::Scenario& scenario : scenarios) {
    if (!options.json) std::cerr << scenario.name << ": " << scenario.shows << '\n';
    runs.push_back(simulate_into_folder(options, scenario, out + "/" + scenario.name));
  }
  const std::string table = table_text(runs);
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
  require_criteria(runs);
}

void simulate_many(const SimulateOptions& options, const sim::Scenario& scenario) {
  evaluation::ManyRuns many;
  const Clock::time_point begin = Clock::now();
  many.runs.resize(static_cast<std::size_t>(options.runs));
  many.simulated_s = options.runs * settings_of(options, scenario).scenario.duration_s;
  std::atomic<int> next{0}, done{0};
  commandline::Progress progress("runs", static_cast<std::uint64_t>(options.runs));
  const auto work = [&] {
    for (int i = next++; i < options.runs; i = next++) {
      many.runs[static_cast<std::size_t>(i)] =
          simulate_seed(options, scenario, scenario.seed + static_cast<std::uint64_t>(i));
      progress.show(static_cast<std::uint64_t>(++done));
    }
  };
  const unsigned threads =
      options.error_model_file.empty() ? 1 : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < threads; ++i) workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) worker.get();
  progress.clear();
  if (options.json) {
    std::cout << evaluation::to_json(many).dump(2) << '\n';
    return;
  }
  std::cout << evaluation::many_runs_table(many)
            << fmt::format("{} runs, {:.0f} s simulated, {:.0f} x real time\n", many.runs.size(),
                           many.simulated_s, many.simulated_s / seconds_since(begin));
}

}  // namespace heel::cli
