// heel export: a recording as files for other programs.
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.h"
#include "heel/error.h"
#include "recording/csv_export.h"

namespace heel::cli {
namespace {

struct ExportOptions {
  std::string recording;
  std::string out;
  bool csv = false;
  bool json = false;
};

void run_export(const ExportOptions& options) {
  if (!options.csv) throw Error("nothing to export (expected --csv)");
  const std::string file = recording_in(options.recording);
  const std::string folder = options.out.empty() ? std::filesystem::path(file).stem().string() : options.out;
  const RecordingReport report = export_csv(file, folder);
  for (const std::string& problem : report.problems) std::cerr << "heel export: " << problem << '\n';
  if (options.json) {
    nlohmann::ordered_json json{{"recording", file}, {"problems", report.problems}};
    for (const char* name : {"ticks.csv", "poses.csv", "capture.csv", "events.log"})
      json["files"].push_back(folder + "/" + name);
    std::cout << json.dump(2) << '\n';
    return;
  }
  std::cout << file << " -> " << folder << "/ticks.csv, poses.csv, capture.csv, events.log\n";
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto options = std::make_shared<ExportOptions>();
  CLI::App* command =
      app.add_subcommand("export", "Writes a recording as CSV files for PlotJuggler, pandas and numpy");
  command
      ->add_option("recording", options->recording,
                   "a recording (*.mcap), or a folder of which the newest one is taken")
      ->required()
      ->type_name("RECORDING");
  command->add_flag("--csv", options->csv, "ticks.csv, poses.csv, capture.csv and events.log");
  command->add_option("-o,--out", options->out, "folder for them (default: the recording's name)")
      ->type_name("DIR");
  command->add_flag("--json", options->json, "one JSON object (default: text)");
  command->callback([options] { run_export(*options); });
}

}  // namespace heel::cli
