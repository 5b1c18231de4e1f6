#include "tune_report.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <span>

#include "evaluation/tuning/tuning_cost.h"

namespace heel::cli {
namespace {

using evaluation::CostTerm;
using evaluation::FollowMetrics;

double mean_of(const CostTerm& term, std::span<const FollowMetrics> runs) {
  double sum = 0.0;
  for (const FollowMetrics& run : runs) sum += term.value(run);
  return sum / static_cast<double>(runs.size());
}

/// Runs in which the robot touched something, came too near, or lost the person.
int failures_of(std::span<const FollowMetrics> runs) {
  int failures = 0;
  for (const FollowMetrics& run : runs) failures += evaluation::cost_of(run) >= evaluation::kFailureCost;
  return failures;
}

std::span<const FollowMetrics> runs_of(const TuneReport& report, const evaluation::Judgement& judgement,
                                       std::size_t scenario) {
  const auto seeds = static_cast<std::size_t>(report.aside.seeds);
  return std::span(judgement.runs).subspan(scenario * seeds, seeds);
}

nlohmann::ordered_json figures_of(std::span<const FollowMetrics> runs) {
  nlohmann::ordered_json json;
  for (const CostTerm& term : evaluation::cost_terms()) json[std::string(term.name)] = mean_of(term, runs);
  json["failed_runs"] = failures_of(runs);
  return json;
}

std::string seeds_text(const evaluation::TuningRuns& runs) {
  return fmt::format("{} to {}", runs.first_seed,
                     runs.first_seed + static_cast<std::uint64_t>(runs.seeds) - 1);
}

std::string scenario_names(const TuneReport& report) {
  std::string names;
  for (const auto& settings : report.searched.scenarios)
    names += (names.empty() ? "" : ", ") + settings.scenario.name;
  return names;
}

}  // namespace

bool TuneReport::better() const {
  return aside_after.cost < (1.0 - kWorthIt) * aside_before.cost;
}

std::string text_of(const TuneReport& report) {
  std::string text = fmt::format("{:<32} {:>9} {:>9}   {}\n", "key", "before", "after", "sought within");
  for (std::size_t i = 0; i < report.keys.size(); ++i)
    text += fmt::format("{:<32} {:9.3f} {:9.3f}   {:.3g} to {:.3g}\n", report.keys[i].name(),
                        report.before[i], report.after[i], report.keys[i].low, report.keys[i].high);
  text += fmt::format("\n{:<32} {:>9} {:>9}   {}\n", "seeds " + seeds_text(report.aside) + ", kept aside",
                      "before", "after", "aim");
  for (const CostTerm& term : evaluation::cost_terms())
    text +=
        fmt::format("{:<32} {:9.4f} {:9.4f}   {} {}\n", term.name, mean_of(term, report.aside_before.runs),
                    mean_of(term, report.aside_after.runs), term.aim, term.unit);
  text += fmt::format("{:<32} {:9} {:9}   0\n", "failed runs", failures_of(report.aside_before.runs),
                      failures_of(report.aside_after.runs));
  return text +
         fmt::format("{:<32} {:9.3f} {:9.3f}\n", "cost", report.aside_before.cost, report.aside_after.cost);
}

std::vector<std::string> provenance_of(const TuneReport& report) {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return {fmt::format("{:%Y-%m-%d}, law {}, scenarios {}", fmt::localtime(now), report.law,
                      scenario_names(report)),
          fmt::format("sought with seeds {} in {} steps; with seeds {}: cost {:.3f}, before {:.3f}",
                      seeds_text(report.searched), report.steps.size(), seeds_text(report.aside),
                      report.aside_after.cost, report.aside_before.cost)};
}

nlohmann::ordered_json to_json(const TuneReport& report) {
  nlohmann::ordered_json json{{"law", report.law},
                              {"seeds", report.searched.seeds},
                              {"first_seed", report.searched.first_seed},
                              {"first_seed_aside", report.aside.first_seed},
                              {"interrupted", report.interrupted},
                              {"better", report.better()},
                              {"cost_before", report.aside_before.cost},
                              {"cost_after", report.aside_after.cost}};
  for (std::size_t i = 0; i < report.keys.size(); ++i)
    json["keys"].push_back({{"key", report.keys[i].name()},
                            {"before", report.before[i]},
                            {"after", report.after[i]},
                            {"low", report.keys[i].low},
                            {"high", report.keys[i].high}});
  for (const CostTerm& term : evaluation::cost_terms())
    json["aims"].push_back({{"name", term.name}, {"unit", term.unit}, {"aim", term.aim}});
  for (std::size_t i = 0; i < report.aside.scenarios.size(); ++i)
    json["scenarios"].push_back({{"scenario", report.aside.scenarios[i].scenario.name},
                                 {"before", figures_of(runs_of(report, report.aside_before, i))},
                                 {"after", figures_of(runs_of(report, report.aside_after, i))}});
  for (const evaluation::SearchStep& step : report.steps)
    json["steps"].push_back({{"values", step.values}, {"cost", step.cost}, {"least_cost", step.least_cost}});
  return json;
}

}  // namespace heel::cli
