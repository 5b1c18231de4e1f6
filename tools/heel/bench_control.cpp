// heel bench control: how late heeld's control ticks start, beside cyclictest.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "bench_load.h"
#include "bench_viewers.h"
#include "commands.h"
#include "core/config.h"
#include "evaluation/benchmarks/machine.h"
#include "heel/error.h"
#include "realtime/clock.h"
#include "recording/recording_reader.h"
#include "simulated_walk.h"

namespace heel::cli {
namespace {

using ControlJson = nlohmann::ordered_json;

constexpr const char* kCyclictest = "/usr/bin/cyclictest";
constexpr double kControlSettle_s = 2.0;
constexpr int kLongest_us = 1000000;
constexpr double kGoalRatio = 1.2;         // of cyclictest's lateness
constexpr int kViewers = 5;                // of the page, with pictures
constexpr double kGoalLoadedRatio = 1.05;  // of the loaded p99.9 to the idle one

struct BenchControlOptions {
  double seconds = 60.0;
  bool json = false;
};

/// Microseconds.
struct Lateness {
  std::size_t count = 0;
  double p50_us = 0.0, p99_us = 0.0, p999_us = 0.0, max_us = 0.0;
  std::size_t missed = 0;  ///< a period or more too late
};

Lateness lateness_of(std::vector<double> times_us, double period_us) {
  std::sort(times_us.begin(), times_us.end());
  const auto quantile = [&](double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(times_us.size())));
    return times_us.empty() ? 0.0 : times_us[std::clamp<std::size_t>(rank, 1, times_us.size()) - 1];
  };
  const auto missed = static_cast<std::size_t>(
      std::count_if(times_us.begin(), times_us.end(), [&](double time_us) { return time_us >= period_us; }));
  return {times_us.size(), quantile(0.5), quantile(0.99), quantile(0.999), quantile(1.0), missed};
}

class TickLateness final : public RecordingVisitor {
 public:
  explicit TickLateness(TimeNs begin_ns, TimeNs end_ns) : begin_ns_(begin_ns), end_ns_(end_ns) {}
  void on_tick(const TickRecord& tick) override {
    if (tick.input.now_ns < begin_ns_ || tick.input.now_ns >= end_ns_) return;
    times_us.push_back(1e-3 * static_cast<double>(tick.input.lateness_ns));
  }
  bool wants(std::string_view topic) const override { return topic == "/heel/tick"; }

  std::vector<double> times_us;

 private:
  const TimeNs begin_ns_, end_ns_;
};

std::vector<double> cyclictest_times_us(const std::string& json_file) {
  std::ifstream file(json_file);
  const ControlJson json = ControlJson::parse(file, nullptr, /*allow_exceptions=*/false);
  std::vector<double> times_us;
  try {
    for (const auto& [time_us, count] : json.at("thread").at("0").at("histogram").items())
      times_us.insert(times_us.end(), count.get<std::size_t>(), std::stod(time_us));
  } catch (const ControlJson::exception&) {
    throw Error("cyclictest: its output has no histogram (expected Debian's rt-tests 2.4)");
  }
  return times_us;
}

struct Beside {
  Lateness heeld, cyclictest;
  std::size_t sets = 0, watched = 0, pictures = 0;  ///< what the load did
};

/// Both at once: the same priority, period, load and time.
Beside measure(const BenchControlOptions& options, bool loaded) {
  const Config defaults;
  const double period_us = 1e6 / defaults.control.rate_hz;
  SimulatedWalk walk({.pictures = loaded ? "lossless" : "none",
                      .more_config = loaded ? "[view]\naddress = \"127.0.0.1:0\"\n" : "",
                      .camera = loaded});
  if (loaded) {
    walk.wait_until_following(kControlSettle_s);
  } else {
    walk.wait_until_linked();
  }
  auto viewers = loaded ? std::make_unique<BenchViewers>(walk.page_port(), kViewers) : nullptr;
  auto load = loaded ? std::make_unique<BenchLoad>(walk.file(""), walk.socket()) : nullptr;
  const std::string result = walk.file("cyclictest.json");
  Beside beside;
  const TimeNs begin_ns = monotonic_now_ns();
  {
    BackgroundProgram cyclictest({kCyclictest, "--quiet", "--mlockall", "--threads=1", "--policy=fifo",
                                  fmt::format("--priority={}", defaults.runtime.priority_control),
                                  fmt::format("--interval={:.0f}", period_us),
                                  fmt::format("--loops={:.0f}", options.seconds * defaults.control.rate_hz),
                                  fmt::format("--histogram={}", kLongest_us), "--json=" + result},
                                 walk.file("cyclictest.log"));
    cyclictest.wait_for_end(2.0 * options.seconds + 60.0);
  }
  TickLateness ticks(begin_ns, monotonic_now_ns());
  if (load) beside.sets = load->sets(), beside.watched = load->watched();
  if (viewers) beside.pictures = viewers->pictures();
  walk.daemon().require_running();
  load.reset();
  viewers.reset();
  walk.end();
  read_recording(recording_in(walk.file("recordings")), ticks);
  beside.heeld = lateness_of(std::move(ticks.times_us), period_us);
  beside.cyclictest = lateness_of(cyclictest_times_us(result), period_us);
  return beside;
}

ControlJson json_of(const Lateness& lateness) {
  return {{"count", lateness.count},      {"p50_us", lateness.p50_us}, {"p99_us", lateness.p99_us},
          {"p99_9_us", lateness.p999_us}, {"max_us", lateness.max_us}, {"missed", lateness.missed}};
}

ControlJson json_of(const Beside& beside) {
  const Lateness &h = beside.heeld, &c = beside.cyclictest;
  ControlJson json{{"heeld", json_of(h)}, {"cyclictest", json_of(c)}};
  json["ratio"] = {
      {"p50", h.p50_us / c.p50_us}, {"p99", h.p99_us / c.p99_us}, {"p99_9", h.p999_us / c.p999_us}};
  json["sets"] = beside.sets;
  json["watched_lines"] = beside.watched;
  json["viewed_pictures"] = beside.pictures;
  return json;
}

std::string rows(const char* name, const Beside& beside) {
  std::string text;
  for (const auto& [who, l] : {std::pair("heeld", beside.heeld), std::pair("cyclictest", beside.cyclictest)})
    text += fmt::format("{:<7} {:<11} {:>8} {:>9.0f} {:>9.0f} {:>9.0f} {:>9.0f} {:>7}\n", name, who, l.count,
                        l.p50_us, l.p99_us, l.p999_us, l.max_us, l.missed);
  const Lateness &h = beside.heeld, &c = beside.cyclictest;
  return text + fmt::format("{:<7} {:<11} {:>8} {:>9.2f} {:>9.2f} {:>9.2f}   (goal {:.1f})\n", name, "ratio",
                            "", h.p50_us / c.p50_us, h.p99_us / c.p99_us, h.p999_us / c.p999_us, kGoalRatio);
}

void run_bench_control(const BenchControlOptions& options) {
  if (!std::filesystem::exists(kCyclictest))
    throw Error(std::string(kCyclictest) + ": not there (install the Debian package rt-tests)");
  const Beside idle = measure(options, false), loaded = measure(options, true);
  const double loaded_to_idle = loaded.heeld.p999_us / idle.heeld.p999_us;
  const double yardstick = loaded.cyclictest.p999_us / idle.cyclictest.p999_us;
  if (!options.json) {
    std::cout << fmt::format("{:<7} {:<11} {:>8} {:>9} {:>9} {:>9} {:>9} {:>7}\n", "µs", "", "ticks", "p50",
                             "p99", "p99.9", "max", "missed")
              << rows("idle", idle) << rows("loaded", loaded)
              << fmt::format("loaded by: {} `set`, {} lines to watchers, {} pictures to {} viewers\n",
                             loaded.sets, loaded.watched, loaded.pictures, kViewers)
              << fmt::format("p99.9 loaded / idle: {:.2f} (goal {:.2f}); cyclictest's: {:.2f}\n",
                             loaded_to_idle, kGoalLoadedRatio, yardstick);
    return;
  }
  std::cout << ControlJson{{"machine", json_of(evaluation::this_machine())},
                           {"seconds", options.seconds},
                           {"idle", json_of(idle)},
                           {"loaded", json_of(loaded)},
                           {"p99_9_loaded_to_idle", loaded_to_idle},
                           {"cyclictest_p99_9_loaded_to_idle", yardstick},
                           {"goal_ratio", kGoalRatio},
                           {"goal_loaded_to_idle", kGoalLoadedRatio}}
                   .dump(2)
            << '\n';
}

}  // namespace

void add_bench_control_command(CLI::App& bench) {
  auto options = std::make_shared<BenchControlOptions>();
  CLI::App* command = bench.add_subcommand(
      "control",
      "How late the control ticks of heeld start, beside cyclictest of "
      "the same priority and period at the same\n"
      "time: idle (no pictures), then loaded: vision follows, every "
      "picture is recorded, a core is busy, the disk and\n"
      "the network are, five people look at the page, and five watchers, ten `set` and twenty marks "
      "a second ask. Needs real-time priorities\n"
      "(root, or CAP_SYS_NICE) and the Debian package rt-tests.");
  command->add_option("--seconds", options->seconds, "of each of the two")
      ->type_name("S")
      ->check(number_from(2.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object (default: a table)");
  command->callback([options] { run_bench_control(*options); });
}

}  // namespace heel::cli
