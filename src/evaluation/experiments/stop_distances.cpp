#include "evaluation/experiments/stop_distances.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "files/csv_file.h"
#include "heel/error.h"
#include "sim/lockstep/lockstep.h"

namespace heel::evaluation {
namespace {

constexpr double kTriggered_s = 20.0;  // by then the robot follows at the person's speed
constexpr double kAtRest_m_s = 0.005;
constexpr int kDecimals = 4;
constexpr double kTaught_m = 1.5;
constexpr std::uint64_t kSeeds = 5;

sim::LockstepSettings walk_with(StopTrigger trigger, double v_m_s, const Config& config,
                                const sim::ErrorModel& errors, std::uint64_t seed) {
  sim::LockstepSettings settings;
  settings.config = config;
  settings.errors = errors;
  settings.shirt.distance_m = kTaught_m;
  sim::Scenario& scenario = settings.scenario;
  scenario.name = "stop";
  scenario.seed = seed;
  scenario.duration_s = kTriggered_s + 6.0;
  scenario.walk_after_s = 0.5;
  scenario.path = {sim::WalkItem{.speed_m_s = v_m_s, .length_m = 1.5 * v_m_s * scenario.duration_s}};
  scenario.robot.x_m = -kTaught_m - config.camera.mount_x_m;
  scenario.camera.model = sim::default_camera_model();
  sim::apply_scenario(scenario, settings.config);
  // The gate holds the speed that is asked for: a faster person does not change it.
  settings.config.gate.v_max_m_s = v_m_s;
  settings.operator_actions = {{0.0, OperatorCommand::Start}};
  // The first start is refused while the robot connects: it is repeated.
  for (int second = 1; second < static_cast<int>(kTriggered_s); ++second)
    settings.operator_actions.push_back({static_cast<double>(second), OperatorCommand::Start});
  switch (trigger) {
    case StopTrigger::EStop:
      settings.operator_actions.push_back({kTriggered_s, OperatorCommand::EStop});
      break;
    case StopTrigger::Stop:
      settings.operator_actions.push_back({kTriggered_s, OperatorCommand::Stop});
      break;
    case StopTrigger::RobotSilent:
      scenario.robot.faults.push_back(fmt::format("silence@{}", kTriggered_s));
      break;
    case StopTrigger::LineCut:
      scenario.robot.faults.push_back(fmt::format("drop@{}=1", kTriggered_s));
      break;
  }
  return settings;
}

class StopObserver : public sim::LockstepObserver {
 public:
  void on_tick(const TickRecord& /*tick*/, const sim::LockstepTruth& truth) override {
    const double t_s = seconds_from_ns(truth.t_ns);
    const sim::RobotTruth& robot = truth.robot;
    if (t_s < kTriggered_s) {
      last_ = robot;
      t_triggered_s_ = t_s;
      return;
    }
    if (at_rest) return;
    distance_m += std::hypot(robot.pose.x_m - last_.pose.x_m, robot.pose.y_m - last_.pose.y_m);
    if (v_m_s == 0.0) v_m_s = last_.v_m_s;
    last_ = robot;
    rest_s = t_s - t_triggered_s_;
    at_rest = std::abs(robot.v_m_s) < kAtRest_m_s;
  }
  double v_m_s = 0.0, distance_m = 0.0, rest_s = 0.0;
  bool at_rest = false;

 private:
  sim::RobotTruth last_;
  double t_triggered_s_ = 0.0;
};

}  // namespace

std::string_view to_string(StopTrigger trigger) {
  switch (trigger) {
    case StopTrigger::EStop:
      return "estop";
    case StopTrigger::Stop:
      return "stop";
    case StopTrigger::RobotSilent:
      return "robot silent";
    case StopTrigger::LineCut:
      return "line cut";
  }
  return "?";
}

std::vector<double> stop_speeds_m_s(const Config& config) {
  std::vector<double> speeds;
  constexpr double kStep_m_s = 0.1;
  for (int i = 2; i * kStep_m_s < config.gate.v_max_m_s - 1e-9; ++i) speeds.push_back(i * kStep_m_s);
  speeds.push_back(config.gate.v_max_m_s);
  return speeds;
}

StopDistance measure_stop(StopTrigger trigger, double v_m_s, const Config& config,
                          const sim::ErrorModel& errors, std::uint64_t seed) {
  StopObserver run;
  run_lockstep(walk_with(trigger, v_m_s, config, errors, seed), run);
  if (!run.at_rest)
    throw Error(
        fmt::format("{}: the robot is not at rest {} s after it ({:.2f} m/s)", to_string(trigger), 6, v_m_s));
  return {trigger, seed, run.v_m_s, run.rest_s, run.distance_m};
}

std::vector<StopDistance> measure_stops(const Config& config, const sim::ErrorModel& errors,
                                        std::uint64_t first_seed, const ProgressCallback& on_progress) {
  std::vector<StopDistance> stops;
  const std::vector<double> speeds_m_s = stop_speeds_m_s(config);
  const std::size_t all = speeds_m_s.size() * std::size(kStopTriggers) * kSeeds;
  for (const double v_m_s : speeds_m_s)
    for (const StopTrigger trigger : kStopTriggers)
      for (std::uint64_t seed = first_seed; seed < first_seed + kSeeds; ++seed) {
        stops.push_back(measure_stop(trigger, v_m_s, config, errors, seed));
        on_progress(stops.size(), all);
      }
  return stops;
}

void write_stop_distances(const std::vector<StopDistance>& stops, const std::string& path) {
  CsvFile file(path, "trigger,seed,v_m_s,rest_s,distance_m");
  for (const StopDistance& stop : stops) {
    file.text(to_string(stop.trigger)).count(stop.seed);
    for (const double value : {stop.v_m_s, stop.rest_s, stop.distance_m}) file.number(value, kDecimals);
    file.end_row();
  }
  file.flush();
}

std::string stop_distance_table(const std::vector<StopDistance>& stops, const Config& config) {
  struct Longest {
    double rest_s = 0.0, distance_m = 0.0;
  };
  std::map<long, std::map<StopTrigger, Longest>> by_speed;  // tenths of m/s
  for (const StopDistance& stop : stops) {
    Longest& longest = by_speed[std::lround(10.0 * stop.v_m_s)][stop.trigger];
    longest.rest_s = std::max(longest.rest_s, stop.rest_s);
    longest.distance_m = std::max(longest.distance_m, stop.distance_m);
  }
  std::string text = "| speed, m/s | kept free by the gate, m |";
  std::string line = "|---|---|";
  for (const StopTrigger trigger : kStopTriggers) {
    text += fmt::format(" {} |", to_string(trigger));
    line += "---|";
  }
  text += "\n" + line + "\n";
  for (const auto& [tenths, longest] : by_speed) {
    const double v_m_s = 0.1 * static_cast<double>(tenths);
    text += fmt::format("| {:.1f} | {:.2f} |", v_m_s, v_m_s * v_m_s / config.gate.deceleration_m_s2);
    for (const StopTrigger trigger : kStopTriggers) {
      const auto found = longest.find(trigger);
      text += found == longest.end()
                  ? " |"
                  : fmt::format(" {:.2f} m, {:.2f} s |", found->second.distance_m, found->second.rest_s);
    }
    text += "\n";
  }
  return text;
}

}  // namespace heel::evaluation
