// heel latency: where the time goes between a frame's exposure and the command that it leads to.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "evaluation/reports/latency_figures.h"
#include "evaluation/reports/plots.h"
#include "files/atomic_file.h"
#include "files/image_file.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

using evaluation::LatencyFigures;
using evaluation::LatencyHop;
using LatencyJson = nlohmann::ordered_json;

struct LatencyOptions {
  std::string recording;
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
  return text +
         fmt::format(
             "goal: dequeued to last byte, p99 at most that of vision and a control period: {:.2f} ms\n",
             goal_ms(figures));
}

void run_latency(const LatencyOptions& options) {
  if (!options.picture.empty()) require_writable_image_name(options.picture);
  const LatencyFigures figures = evaluation::latency_of(options.recording);
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
                                         "99th percentile and longest");
  command
      ->add_option("recording", options->recording,
                   "a recording (*.mcap), or a folder of which the newest one is taken")
      ->required()
      ->type_name("RECORDING");
  command->add_flag("--json", options->json, "one JSON object (default: a table)");
  command
      ->add_option("--picture", options->picture,
                   "draw them as a waterfall: P.png and P.svg from P.json, which needs the Debian package\n"
                   "python3-matplotlib")
      ->type_name("P.png");
  command->callback([options] { run_latency(*options); });
}

}  // namespace heel::cli
