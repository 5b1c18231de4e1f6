// heel report: a summary, numbers and figures of a finished run's folder, or of a folder of experiments.
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.h"
#include "evaluation/reports/experiment_report.h"
#include "evaluation/reports/plots.h"
#include "evaluation/reports/run_files.h"
#include "evaluation/reports/run_report.h"

namespace heel::cli {
namespace {

struct ReportOptions {
  std::string directory;
  bool json = false;
  evaluation::FollowCriteria criteria;
};

/// Says why where the figures cannot be drawn: the numbers are written all the same.
void draw(const std::string& directory) {
  if (const std::string why_not = evaluation::draw_figures({directory}); !why_not.empty())
    std::cerr << "heel report: " << why_not << '\n';
}

void run_report(const ReportOptions& options) {
  const std::string& directory = options.directory;
  if (!std::filesystem::exists(directory + "/truth.csv") && evaluation::holds_experiments(directory)) {
    const std::string summary = evaluation::report_experiments(directory);
    const nlohmann::ordered_json json{{"directory", directory}, {"summary", summary}};
    std::cout << (options.json ? json.dump(2) + "\n" : summary) << std::flush;
    draw(directory);
    return;
  }
  const evaluation::MetricsCollector run = evaluation::read_run(directory);
  const evaluation::FollowMetrics metrics = run.evaluate();
  const auto failed = evaluation::failed_criteria(metrics, options.criteria);
  const evaluation::RunReport report = evaluation::write_run_report(directory, run, metrics, failed);
  std::cout << (options.json ? report.json.dump(2) + "\n" : report.text) << std::flush;
  draw(directory);
  for (const std::string& reason : failed) std::cerr << "heel report: " << reason << '\n';
  if (!failed.empty()) throw CLI::RuntimeError(kExitNo);
}

}  // namespace

void add_report_command(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report",
                         "Writes summary.txt, summary.json and the figures path, errors and "
                         "frames into a run's folder; summary.md and fig1 ... fig8 into a "
                         "folder of `heel experiment`. Figures are PNG and SVG with their "
                         "numbers as CSV; drawing needs the Debian package python3-matplotlib");
  command->add_option("directory", options->directory, "holds truth.csv and a recording; or experiments")
      ->required()
      ->type_name("DIR");
  command->add_flag("--json", options->json,
                    "print the summary as JSON: of experiments the text of summary.md, as `summary`");
  add_criteria_options(*command, options->criteria);
  command->callback([options] { run_report(*options); });
}

}  // namespace heel::cli
