// heel simulate: a scenario through the daemon's own stages in lock step, and how well it was followed.
#include <chrono>
#include <cstdio>
#include <iostream>
#include <string>

#include "commands.h"
#include "heel/error.h"
#include "heel/lockstep/lockstep.h"
#include "heel/lockstep/metrics.h"
#include "heel/lockstep/run_record.h"
#include "runtime/config_load.h"

namespace heel::cli {
namespace {

struct SimulateOptions {
  std::string scenario;
  std::string config_file;
  std::string template_file;
  std::string out;
  double teach_distance_m = 1.5;
  long long seed = -1;
  double duration_s = 0.0;
  bool json = false;
  sim::FollowCriteria criteria;
};

sim::LockstepSettings settings_of(const SimulateOptions& options) {
  sim::LockstepSettings settings;
  settings.scenario = sim::read_scenario(options.scenario);
  if (options.seed >= 0) settings.scenario.seed = static_cast<std::uint64_t>(options.seed);
  if (options.duration_s > 0.0) settings.scenario.duration_s = options.duration_s;
  if (!options.config_file.empty()) settings.config = load_config(options.config_file).config;
  sim::apply_scenario(settings.scenario, settings.config);
  if (!options.template_file.empty())
    settings.shirt = read_template(options.template_file);
  else if (settings.scenario.camera.source == "sim")
    settings.shirt = sim::teach_from_world(settings.scenario, options.teach_distance_m);
  else
    throw Error("--template: missing (expected a template for frames from " +
                settings.scenario.camera.source + ")");
  return settings;
}

void print_table(const sim::FollowMetrics& m, const sim::LockstepCounts& counts, double speed) {
  constexpr double kDeg = 57.29577951308232;
  std::printf("person walked %.2f m, robot %.2f m\n", m.person_path_m, m.robot_path_m);
  std::printf("beside the person's path: %.3f m RMS, %.3f to %.3f m\n", m.lateral_m.rms, m.lateral_m.lowest,
              m.lateral_m.highest);
  std::printf("separation: %.2f m mean, %.2f to %.2f m\n", m.separation_m.mean, m.separation_m.lowest,
              m.separation_m.highest);
  std::printf("found in %llu of %llu frames, longest out of view %.2f s, in all %.2f s\n",
              static_cast<unsigned long long>(m.frames_found), static_cast<unsigned long long>(m.frames),
              m.out_of_view_longest_s, m.out_of_view_total_s);
  std::printf("certainty 5/50/95 %%: %.2f %.2f %.2f\n", m.certainty.p05, m.certainty.p50, m.certainty.p95);
  std::printf("yaw error: mean %+.2f, deviation %.2f, 5/95 %% %+.1f %+.1f degrees; (error/sigma)^2 %.2f\n",
              kDeg * m.yaw_error_rad.mean, kDeg * m.yaw_error_rad.deviation, kDeg * m.yaw_error_rad.p05,
              kDeg * m.yaw_error_rad.p95, m.yaw_nees);
  std::printf("position error RMS: x %.3f, y %.3f, z %.3f m (z mean %+.3f m)\n", m.x_error_m.rms,
              m.y_error_m.rms, m.z_error_m.rms, m.z_error_m.mean);
  for (const auto& [reason, times] : m.stops_by_reason)
    std::printf("stopped %d times: %s (%.2f s)\n", times, reason.c_str(), m.rest_s_by_reason.at(reason));
  std::printf("%llu ticks, %llu frames (%llu overtaken), %.1f x real time\n",
              static_cast<unsigned long long>(counts.ticks), static_cast<unsigned long long>(counts.frames),
              static_cast<unsigned long long>(counts.frames_overtaken), speed);
}

void run_simulate(const SimulateOptions& options) {
  const sim::LockstepSettings settings = settings_of(options);
  sim::RunRecord record(options.out, settings);
  const auto begin = std::chrono::steady_clock::now();
  const sim::LockstepCounts counts = sim::run_lockstep(settings, record);
  const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const sim::FollowMetrics metrics = record.metrics().evaluate();
  const auto failed = sim::failed_criteria(metrics, options.criteria);
  if (options.json) {
    // No wall-clock figure here: the same run prints the same bytes.
    nlohmann::ordered_json json{{"scenario", settings.scenario.name},
                                {"seed", settings.scenario.seed},
                                {"ticks", counts.ticks},
                                {"frames_overtaken", counts.frames_overtaken}};
    json.update(sim::to_json(metrics));
    json["failed"] = failed;
    std::cout << json.dump(2) << '\n';
  } else {
    print_table(metrics, counts, settings.scenario.duration_s / took_s);
  }
  for (const std::string& reason : failed) std::cerr << "heel simulate: " << reason << '\n';
  if (!failed.empty()) throw CLI::RuntimeError(kExitNo);
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app.add_subcommand(
      "simulate",
      "Runs a scenario in lock step with the simulated world; exit status 1 when a limit is not met");
  command->add_option("scenario", options->scenario, "scenario file (TOML)")->required();
  command->add_option("--seed", options->seed, "instead of the scenario's")->check(CLI::NonNegativeNumber);
  command->add_option("--duration", options->duration_s, "seconds, instead of the scenario's")
      ->check(CLI::PositiveNumber);
  command->add_option("--config", options->config_file, "the daemon's configuration (default: its defaults)");
  command->add_option("--template", options->template_file,
                      "template file (default: taught from the world's reference view)");
  command->add_option("--teach-distance", options->teach_distance_m, "of that view, metres")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  command->add_option("--out", options->out,
                      "folder for truth.csv, ticks.csv, poses.csv, wire.hex and frames");
  command->add_flag("--json", options->json, "metrics as JSON");
  command->add_option("--max-out-of-view-s", options->criteria.max_out_of_view_s, "fail when longer");
  command->add_option("--max-rms-m", options->criteria.max_rms_m, "fail when the paths lie farther apart");
  command->add_option("--min-path-m", options->criteria.min_robot_path_m,
                      "fail when the robot goes less far");
  command->callback([options] { run_simulate(*options); });
}

}  // namespace heel::cli
