// heel preflight: is everything ready to follow? Camera, calibration, shirt, person, robot and wheels, each
// measured, through the daemon's own parts.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "commands.h"
#include "config/config_load.h"
#include "preflight_step.h"

namespace heel::cli {
namespace {

struct PreflightOptions {
  std::string config_file;
  std::vector<std::string> steps;
  bool wheels_on_blocks = false;
  bool json = false;
};

PreflightStep run_step(const NamedStep& named, const Config& config, const PreflightOptions& options) {
  if (named.check == check_wheels && !options.wheels_on_blocks)
    return {.name = named.name,
            .verdict = StepVerdict::Skipped,
            .measured = "the wheels would turn: lift them off the floor and add --wheels-on-blocks"};
  return named.check(config);
}

void run_preflight(const PreflightOptions& options) {
  const Config config = load_config(options.config_file).config;
  note_interrupts();
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  bool failed = false;
  for (const NamedStep& named : preflight_steps()) {
    const bool wanted =
        options.steps.empty() || std::ranges::find(options.steps, named.name) != options.steps.end();
    if (!wanted || g_preflight_interrupted) continue;
    const PreflightStep step = run_step(named, config, options);
    failed = failed || step.verdict == StepVerdict::Fail;
    steps.push_back(json_of(step));
    if (!options.json) std::cout << text_of(step) << std::flush;
  }
  const bool ready = !failed && !g_preflight_interrupted;
  if (options.json)
    std::cout << nlohmann::ordered_json{{"ready", ready}, {"steps", steps}}.dump(2) << '\n';
  else if (ready && options.steps.empty())
    std::cout
        << "ready: start heeld, `heel set gate.v_max_m_s=0.2` for a slow first walk, then `heel start`\n";
  if (!ready) throw CLI::RuntimeError(kExitNo);
}

}  // namespace

void add_preflight_command(CLI::App& app) {
  auto options = std::make_shared<PreflightOptions>();
  std::vector<std::string> names;
  std::string help = "only these of:";
  for (const NamedStep& step : preflight_steps()) {
    names.emplace_back(step.name);
    help += fmt::format("\n  {}: {}", step.name, step.measures);
  }
  CLI::App* command = app.add_subcommand(
      "preflight",
      "Measures whether everything is ready to follow, step by step, with what to do about each step that\n"
      "fails (exit status 1). Camera and robot are used directly: stop heeld first.");
  command->add_option("step", options->steps, help)->check(CLI::IsMember(names))->type_name("STEP");
  command->add_option("--config", options->config_file, "the daemon's configuration file")
      ->required()
      ->type_name("FILE");
  command->add_flag("--wheels-on-blocks", options->wheels_on_blocks,
                    "the robot's wheels are off the floor and may turn");
  command->add_flag("--json", options->json, "one JSON object (default: a line a step)");
  command->callback([options] { run_preflight(*options); });
}

}  // namespace heel::cli
