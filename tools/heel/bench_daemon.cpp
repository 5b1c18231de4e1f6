// heel bench daemon: what the whole of heeld costs while it follows.
#include <fmt/format.h>
#include <sched.h>

#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "commands.h"
#include "evaluation/benchmarks/machine.h"
#include "evaluation/metrics/process_figures.h"
#include "realtime/clock.h"
#include "simulated_walk.h"

namespace heel::cli {
namespace {

using evaluation::MemoryFigures;
using evaluation::ThreadFigures;
using BenchJson = nlohmann::ordered_json;

constexpr double kDaemonSettle_s = 3.0;
constexpr double kGoalCore = 0.08;  // of one core
constexpr double kGoalResident_mb = 80.0;
constexpr std::size_t kLargestMappings = 10;

struct BenchDaemonOptions {
  double seconds = 20.0;
  std::string pictures = "none";
  bool json = false;
};

/// Between two readings.
struct ThreadCost {
  ThreadFigures figures;  ///< counts of the time between
  double core_share = 0.0;
};

struct DaemonCost {
  double seconds = 0.0;
  bool followed = false;
  std::vector<ThreadCost> threads;
  double core_share = 0.0;
  MemoryFigures memory;
};

std::vector<ThreadCost> between(const std::vector<ThreadFigures>& before,
                                const std::vector<ThreadFigures>& after, double seconds) {
  std::map<pid_t, ThreadFigures> first;
  for (const ThreadFigures& thread : before) first[thread.id] = thread;
  std::vector<ThreadCost> costs;
  for (ThreadFigures thread : after) {
    const ThreadFigures& then = first[thread.id];
    thread.minor_faults -= then.minor_faults;
    thread.major_faults -= then.major_faults;
    thread.switches -= then.switches;
    thread.forced_switches -= then.forced_switches;
    costs.push_back({thread, (thread.cpu_s - then.cpu_s) / seconds});
  }
  return costs;
}

DaemonCost measure(const BenchDaemonOptions& options) {
  SimulatedWalk walk({.pictures = options.pictures});
  walk.wait_until_following(kDaemonSettle_s);
  const pid_t heeld = walk.daemon().pid();
  DaemonCost cost;
  const TimeNs begin_ns = monotonic_now_ns();
  const std::vector<ThreadFigures> before = evaluation::threads_of(heeld);
  sleep_until_ns(begin_ns + ns_from_seconds(options.seconds));
  const std::vector<ThreadFigures> after = evaluation::threads_of(heeld);
  cost.seconds = seconds_from_ns(monotonic_now_ns() - begin_ns);
  cost.threads = between(before, after, cost.seconds);
  for (const ThreadCost& thread : cost.threads) cost.core_share += thread.core_share;
  cost.memory = evaluation::memory_of(heeld);
  cost.followed = walk.follows();
  return cost;
}

BenchJson json_of(const DaemonCost& cost, const BenchDaemonOptions& options) {
  BenchJson json{{"machine", json_of(evaluation::this_machine())},
                 {"seconds", cost.seconds},
                 {"pictures", options.pictures},
                 {"followed_to_the_end", cost.followed}};
  json["core_share"] = {
      {"all", cost.core_share}, {"goal", kGoalCore}, {"reached", cost.core_share <= kGoalCore}};
  for (const ThreadCost& thread : cost.threads) {
    const ThreadFigures& t = thread.figures;
    json["threads"].push_back({{"name", t.name},
                               {"core_share", thread.core_share},
                               {"realtime_priority", t.policy == SCHED_FIFO ? t.priority : 0},
                               {"minor_faults", t.minor_faults},
                               {"major_faults", t.major_faults},
                               {"switches", t.switches},
                               {"forced_switches", t.forced_switches}});
  }
  const MemoryFigures& memory = cost.memory;
  json["memory"] = {{"resident_mb", memory.resident_mb},
                    {"goal_mb", kGoalResident_mb},
                    {"reached", memory.resident_mb <= kGoalResident_mb},
                    {"peak_mb", memory.peak_mb},
                    {"locked_mb", memory.locked_mb}};
  for (std::size_t i = 0; i < std::min(kLargestMappings, memory.mappings.size()); ++i)
    json["memory"]["largest"].push_back(
        {{"name", memory.mappings[i].name}, {"pss_mb", memory.mappings[i].pss_mb}});
  return json;
}

std::string table_of(const DaemonCost& cost) {
  std::string text = fmt::format("{:<16} {:>10} {:>9} {:>13} {:>16}\n", "thread", "of a core", "priority",
                                 "page faults", "forced switches");
  for (const ThreadCost& thread : cost.threads) {
    const ThreadFigures& t = thread.figures;
    text += fmt::format("{:<16} {:>8.2f} % {:>9} {:>13} {:>16}\n", t.name, 100.0 * thread.core_share,
                        t.priority, t.minor_faults + t.major_faults, t.forced_switches);
  }
  text +=
      fmt::format("{:<16} {:>8.2f} %   (goal {:.0f} %)\n", "all", 100.0 * cost.core_share, 100.0 * kGoalCore);
  text += fmt::format("memory: {:.1f} MB resident (goal {:.0f}), {:.1f} MB at most, {:.1f} MB locked\n",
                      cost.memory.resident_mb, kGoalResident_mb, cost.memory.peak_mb, cost.memory.locked_mb);
  for (std::size_t i = 0; i < std::min(kLargestMappings, cost.memory.mappings.size()); ++i)
    text += fmt::format("  {:>6.1f} MB {}\n", cost.memory.mappings[i].pss_mb, cost.memory.mappings[i].name);
  if (!cost.followed)
    text += "the robot did not follow to the end: these figures are not those of following\n";
  return text;
}

}  // namespace

void add_bench_daemon_command(CLI::App& bench) {
  auto options = std::make_shared<BenchDaemonOptions>();
  CLI::App* command = bench.add_subcommand(
      "daemon",
      "Processor time by thread, and memory, of heeld while it follows a simulated person in real time: "
      "camera\n"
      "of 640x480 pixels and 30 frames a second through shared memory, robot over a pty, recording to a\n"
      "temporary folder. It runs heeld and heel-sim from the folder of this program. Memory without "
      "CAP_IPC_LOCK,\n"
      "or limits of the service, is not locked, and then smaller.");
  command->add_option("--seconds", options->seconds, "measured, after the robot has followed for 3 s")
      ->type_name("S")
      ->check(number_from(1.0, 3600.0))
      ->capture_default_str();
  command->add_option("--pictures", options->pictures, "which pictures heeld records")
      ->check(CLI::IsMember({"none", "on_fault", "jpeg", "lossless"}))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object (default: a table)");
  command->callback([options] {
    const DaemonCost cost = measure(*options);
    std::cout << (options->json ? json_of(cost, *options).dump(2) + "\n" : table_of(cost));
  });
}

}  // namespace heel::cli
