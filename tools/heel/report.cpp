// heel report: figures and a summary from a finished run's folder, or from a folder of experiments.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <opencv2/imgcodecs.hpp>

#include "commands.h"
#include "evaluation/reports/experiment_report.h"
#include "evaluation/reports/figures.h"
#include "evaluation/reports/run_files.h"
#include "evaluation/reports/summary.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

struct ReportOptions {
  std::string directory;
  bool json = false;
  evaluation::FollowCriteria criteria;
};

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw Error(path + ": cannot write (expected a writable folder)");
}

void write_figure(const std::string& path, const cv::Mat& figure) {
  if (figure.empty()) return;
  if (!cv::imwrite(path, figure)) throw Error(path + ": cannot write (expected a writable folder)");
}

void run_report(const ReportOptions& options) {
  const std::string& directory = options.directory;
  if (!std::filesystem::exists(directory + "/truth.csv") && evaluation::holds_experiments(directory)) {
    std::cout << evaluation::report_experiments(directory);
    return;
  }
  const evaluation::MetricsCollector run = evaluation::read_run(directory);
  const evaluation::FollowMetrics metrics = run.evaluate();
  const auto failed = evaluation::failed_criteria(metrics, options.criteria);
  const std::string summary = evaluation::summary_text(metrics, failed);
  nlohmann::ordered_json json = evaluation::to_json(metrics);
  json["failed"] = failed;
  write_text(directory + "/summary.txt", summary);
  write_text(directory + "/summary.json", json.dump(2) + "\n");
  write_figure(directory + "/path.png", evaluation::path_figure(run, metrics));
  write_figure(directory + "/errors.png", evaluation::errors_figure(run));
  write_figure(directory + "/frames.png", evaluation::frames_figure(directory));
  std::cout << (options.json ? json.dump(2) + "\n" : summary);
  for (const std::string& reason : failed) std::cerr << "heel report: " << reason << '\n';
  if (!failed.empty()) throw CLI::RuntimeError(kExitNo);
}

}  // namespace

void add_report_command(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command = app.add_subcommand("report",
                                         "Draws path.png, errors.png and frames.png and writes summary.txt "
                                         "and summary.json into a run's folder; fig1 ... fig8 and summary.md "
                                         "into a folder of `heel experiment`");
  command
      ->add_option("directory", options->directory,
                   "holds truth.csv, ticks.csv and poses.csv; or experiments")
      ->required();
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->add_option("--max-out-of-view-s", options->criteria.max_out_of_view_s,
                      "exit status 1 when longer");
  command->add_option("--max-rms-m", options->criteria.max_rms_m,
                      "exit status 1 when the paths lie farther apart");
  command->add_option("--min-path-m", options->criteria.min_robot_path_m,
                      "exit status 1 when the robot goes less far");
  command->callback([options] { run_report(*options); });
}

}  // namespace heel::cli
