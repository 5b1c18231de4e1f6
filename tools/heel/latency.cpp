// heel latency: where the time goes between a frame's exposure and the command that it leads to; with a light
// that is switched, also what the camera adds.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "config/config_load.h"
#include "evaluation/metrics/light_response.h"
#include "evaluation/reports/latency_figures.h"
#include "evaluation/reports/plots.h"
#include "files/atomic_file.h"
#include "files/image_file.h"
#include "heel/error.h"
#include "light_latency.h"

namespace heel::cli {
namespace {

using evaluation::LatencyFigures;
using evaluation::LatencyHop;
using LatencyJson = nlohmann::ordered_json;

constexpr int kFewestSwitches = 16, kMostSwitches = 1000;

struct LatencyOptions {
  std::string recording;
  std::string truth;
  bool light = false;
  std::string config_file;
  std::string lamp;
  int switches = 20;
  bool json = false;
  std::string picture;
};

LatencyJson json_of(const LatencyHop& hop) {
  return {{"name", hop.name},
          {"count", hop.count},
          {"p50_ms", hop.p50_ms},
          {"p99_ms", hop.p99_ms},
          {"max_ms", hop.max_ms}};
}

/// What the capture may take to become a command: the time of vision and one period of control.
double goal_ms(const LatencyFigures& figures) {
  return figures.hops[2].p99_ms + figures.period_ms;
}

LatencyJson json_of(const LatencyFigures& figures) {
  LatencyJson json{{"recording", figures.file},
                   {"frames", figures.frames},
                   {"commands", figures.commands},
                   {"control_period_ms", figures.period_ms}};
  for (const LatencyHop& hop : figures.hops) json["hops"].push_back(json_of(hop));
  json["total"] = json_of(figures.total);
  json["dequeued_to_last_byte"] = json_of(figures.dequeued_to_last);
  if (figures.to_wheels) json["to_wheels"] = json_of(*figures.to_wheels);
  json["goal_p99_ms"] = goal_ms(figures);
  json["reached"] = figures.dequeued_to_last.p99_ms <= goal_ms(figures);
  json["slowest_ms"] = figures.slowest_ms;
  return json;
}

std::string row(const LatencyHop& hop) {
  return fmt::format("{:<22} {:>8.2f} {:>8.2f} {:>8.2f} {:>8}\n", hop.name, hop.p50_ms, hop.p99_ms,
                     hop.max_ms, hop.count);
}

std::string table_of(const LatencyFigures& figures) {
  std::string text = fmt::format("{}: {} frames, {} commands\n{:<22} {:>8} {:>8} {:>8} {:>8}\n", figures.file,
                                 figures.frames, figures.commands, "ms", "p50", "p99", "max", "frames");
  for (const LatencyHop& hop : figures.hops) text += row(hop);
  text += row(figures.dequeued_to_last) + row(figures.total);
  if (figures.to_wheels) text += row(*figures.to_wheels);
  return text +
         fmt::format(
             "goal: dequeued to last byte, p99 at most that of vision and a control period: {:.2f} ms\n",
             goal_ms(figures));
}

LatencyJson json_of(const LightFigures& figures) {
  LatencyJson json{{"camera", figures.camera},
                   {"switches", figures.switches},
                   {"seen", figures.seen},
                   {"tiles", figures.tiles},
                   {"contrast", figures.contrast},
                   {"with_vision", figures.no_vision.empty()},
                   {"control_period_ms", figures.period_ms}};
  for (const LatencyHop& hop : figures.hops) json["hops"].push_back(json_of(hop));
  json["light_to_dequeued"] = json_of(figures.to_dequeued);
  json["total"] = json_of(figures.total);
  return json;
}

std::string table_of(const LightFigures& figures) {
  std::string text = fmt::format(
      "{}\n{} of {} switches seen, in {} of {} parts of the picture, {:.0f} grey levels\n{:<22} {:>8} {:>8} "
      "{:>8} {:>8}\n",
      figures.camera, figures.seen, figures.switches, figures.tiles,
      evaluation::kTileColumns * evaluation::kTileRows, figures.contrast, "ms", "p50", "p99", "max", "seen");
  for (const LatencyHop& hop : figures.hops) text += row(hop);
  text += row(figures.to_dequeued) + row(figures.total);
  if (!figures.no_vision.empty()) text += "vision is not included: " + figures.no_vision + "\n";
  return text;
}

void run_light(const LatencyOptions& options) {
  if (!options.recording.empty())
    throw Error(options.recording + ": given with --light (expected one of the two)");
  for (const auto& [name, value] :
       {std::pair{"--picture", options.picture}, std::pair{"--truth", options.truth}})
    if (!value.empty()) throw Error(fmt::format("{}: given with --light (expected with a recording)", name));
  if (options.config_file.empty()) throw Error("--config: missing (expected with --light)");
  const LightFigures figures =
      measure_light(load_config(options.config_file).config, options.lamp, options.switches);
  std::cout << (options.json ? json_of(figures).dump(2) + "\n" : table_of(figures));
}

void run_latency(const LatencyOptions& options) {
  if (options.light) return run_light(options);
  for (const auto& [name, value] :
       {std::pair{"--config", options.config_file}, std::pair{"--lamp", options.lamp}})
    if (!value.empty()) throw Error(fmt::format("{}: given without --light", name));
  if (options.recording.empty()) throw Error("a recording: missing (expected one, or --light)");
  if (!options.picture.empty()) require_writable_image_name(options.picture);
  std::optional<evaluation::WheelResponse> wheels;
  if (!options.truth.empty()) wheels.emplace(options.truth);
  const LatencyFigures figures = evaluation::latency_of(options.recording, wheels ? &*wheels : nullptr);
  if (figures.commands == 0) throw Error(figures.file + ": no frame has become a command");
  std::cout << (options.json ? json_of(figures).dump(2) + "\n" : table_of(figures));
  if (options.picture.empty()) return;
  const std::string numbers = std::filesystem::path(options.picture).replace_extension(".json").string();
  write_file_atomically(numbers, json_of(figures).dump(2) + "\n");
  if (const std::string why_not = evaluation::draw_figures({numbers, options.picture}); !why_not.empty())
    throw Error(why_not);
}

}  // namespace

void add_latency_command(CLI::App& app) {
  auto options = std::make_shared<LatencyOptions>();
  CLI::App* command = app.add_subcommand("latency",
                                         "How long each frame took from its exposure to the last byte of the "
                                         "command that used it, by hop: median,\n"
                                         "99th percentile and longest. With --light and without a recording: "
                                         "how long a real camera takes to\n"
                                         "show a light that is switched, and the command that would follow. "
                                         "Stop heeld first; the robot is\n"
                                         "not touched.");
  command
      ->add_option("recording", options->recording,
                   "a recording (*.mcap), or a folder of which the newest one is taken")
      ->type_name("RECORDING");
  command
      ->add_option("--truth", options->truth,
                   "what heel-sim --truth wrote in the same run: how long the wheels took, too")
      ->type_name("T.csv");
  command->add_flag("--light", options->light,
                    "measure the configured camera: it must see the light, and little else may change");
  command->add_option("--config", options->config_file, "with --light: the daemon's configuration file")
      ->type_name("FILE");
  command
      ->add_option("--lamp", options->lamp,
                   "with --light: a file that switches it, such as /sys/class/leds/NAME/brightness\n"
                   "(default: this terminal turns white and black)")
      ->type_name("FILE");
  command->add_option("--switches", options->switches, "with --light: how often the light is switched")
      ->type_name("N")
      ->check(CLI::Range(kFewestSwitches, kMostSwitches))
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object (default: a table)");
  command
      ->add_option("--picture", options->picture,
                   "draw them as a waterfall: P.png and P.svg from P.json, which needs the Debian package\n"
                   "python3-matplotlib")
      ->type_name("P.png");
  command->callback([options] { run_latency(*options); });
}

}  // namespace heel::cli
