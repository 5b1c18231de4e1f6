#include "evaluation/tuning/tuning_runs.h"

#include <algorithm>
#include <future>
#include <thread>

#include "evaluation/experiments/run_record.h"
#include "evaluation/tuning/tuning_cost.h"

namespace heel::evaluation {
namespace {

FollowMetrics run_once(sim::LockstepSettings settings, std::uint64_t seed, std::span<const TunedKey> keys,
                       std::span<const double> values) {
  settings.scenario.seed = seed;
  settings.config = with_values(settings.config, keys, values);
  RunRecord record("", settings);
  sim::run_lockstep(settings, record);
  return record.metrics().evaluate();
}

}  // namespace

Judgement judge(const TuningRuns& runs, std::span<const TunedKey> keys, std::span<const double> values) {
  Judgement judgement;
  const auto seeds = static_cast<std::size_t>(runs.seeds);
  judgement.runs.resize(runs.scenarios.size() * seeds);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < judgement.runs.size(); i = next++)
      judgement.runs[i] = run_once(runs.scenarios[i / seeds], runs.first_seed + i % seeds, keys, values);
  };
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
    workers.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : workers) worker.get();

  for (const FollowMetrics& metrics : judgement.runs) judgement.cost += cost_of(metrics);
  judgement.cost /= static_cast<double>(judgement.runs.size());
  return judgement;
}

}  // namespace heel::evaluation
