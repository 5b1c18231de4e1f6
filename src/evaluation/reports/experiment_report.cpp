#include "evaluation/reports/experiment_report.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "evaluation/reports/error_figures.h"
#include "evaluation/reports/paper_comparison.h"
#include "evaluation/reports/paper_figures.h"
#include "evaluation/reports/real_report.h"
#include "evaluation/reports/run_files.h"
#include "evaluation/reports/style.h"
#include "heel/error.h"

namespace heel::evaluation {
namespace {

namespace fs = std::filesystem;

class Writer {
 public:
  explicit Writer(std::string directory) : directory_(std::move(directory)) {}

  void figure(const std::string& name, const cv::Mat& picture, const std::string& caption) {
    if (picture.empty()) return;
    if (!cv::imwrite(directory_ + "/" + name, picture,
                     {cv::IMWRITE_PNG_COMPRESSION, 9, cv::IMWRITE_JPEG_QUALITY, 62}))
      throw Error(directory_ + "/" + name + ": cannot write (expected a writable folder)");
    figures_ += "![" + caption + "](" + name + ")\n\n";
  }
  void steps(const std::string& name, const std::vector<Step>& steps, const StepFigure& what,
             const std::string& unit) {
    write_steps(steps, unit, directory_ + "/" + name + ".csv");
    figure(name + ".png", step_figure(what, steps), what.title);
  }
  const std::string& figures() const { return figures_; }

 private:
  std::string directory_;
  std::string figures_;
};

std::vector<StillSample> stills_if_any(const std::string& path) {
  return fs::exists(path) ? read_stills(path) : std::vector<StillSample>{};
}

void draw_stills(const ExperimentData& data, Writer& writer) {
  using S = StillSample;
  if (!data.lateral.empty())
    writer.steps("fig2_t_x", steps_of(data.lateral, &S::x_m, &S::x_est_m, &S::true_x_m),
                 {"Figure 2: t_x at sideways offsets, 2 m away", "sideways offset in m", "t_x in m"}, "m");
  if (!data.distance.empty())
    writer.steps("fig3_t_z", steps_of(data.distance, &S::z_m, &S::z_est_m, &S::true_z_m),
                 {"Figure 3: t_z over the distance", "distance in m", "t_z in m"}, "m");
  if (!data.yaw.empty())
    writer.steps("fig4_yaw", steps_of(data.yaw, &S::yaw_rad, &S::yaw_est_rad, &S::true_yaw_rad, kDeg),
                 {"Figure 4: yaw of the back, 2 m away", "true yaw in degrees", "estimated yaw in degrees"},
                 "deg");
}

/// The yaw of a person who does not turn, over where they are: Figures 5 and 6.
void draw_pure_translation(const std::vector<StillSample>& samples, const std::string& name, Member place,
                           const std::string& title, const std::string& x_label, Writer& writer) {
  if (samples.empty()) return;
  // Degrees for the estimate, metres for the place.
  std::vector<StillSample> in_degrees = samples;
  for (StillSample& sample : in_degrees) {
    sample.yaw_est_rad *= kDeg;
    sample.true_yaw_rad *= kDeg;
  }
  writer.steps(name, steps_of(in_degrees, place, &StillSample::yaw_est_rad, &StillSample::true_yaw_rad),
               {title, x_label, "estimated yaw in degrees"}, "deg");
}

/// Runs in the folders below, by name.
std::vector<std::string> run_names(const std::string& directory) {
  std::vector<std::string> names;
  if (!fs::is_directory(directory)) return names;
  for (const auto& entry : fs::directory_iterator(directory))
    if (fs::exists(entry.path() / "truth.csv")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

void draw_runs(const std::string& directory, ExperimentData& data, std::vector<RunLine>& lines,
               Writer& writer) {
  std::optional<MetricsCollector> walk, position_only;
  for (const std::string& name : run_names(directory + "/runs")) {
    const MetricsCollector run = read_run(directory + "/runs/" + name);
    lines.push_back(run_line(name, run));
    if (name == "response")
      writer.figure("fig7_response.png", response_figure(run),
                    "Figure 7: the robot's response to an offset line at another heading");
    if (name == "walk") {
      walk = run;
      data.walk = lines.back();
    }
    if (name == "walk-position-only") {
      position_only = run;
      data.walk_position_only = lines.back();
    }
  }
  if (walk)
    writer.figure("fig8_walk.png", walk_figure(*walk, position_only ? &*position_only : nullptr),
                  "Figure 8: both paths of a long walk");
}

}  // namespace

bool holds_experiments(const std::string& directory) {
  for (const char* name : {"lateral", "distance", "yaw", "hard", "errors"})
    if (fs::exists(directory + "/" + name + ".csv")) return true;
  return !run_names(directory + "/runs").empty();
}

std::string report_experiments(const std::string& directory) {
  Writer writer(directory);
  ExperimentData data;
  data.lateral = stills_if_any(directory + "/lateral.csv");
  data.distance = stills_if_any(directory + "/distance.csv");
  data.yaw = stills_if_any(directory + "/yaw.csv");
  data.errors = stills_if_any(directory + "/errors.csv");

  writer.figure("fig1_hard.jpg", hard_figure(directory), "Figure 1: the shirt found in twelve hard cases");
  draw_stills(data, writer);
  draw_pure_translation(data.lateral, "fig5_yaw_over_x", &StillSample::x_m,
                        "Figure 5: yaw of a person who only moves sideways", "sideways offset in m", writer);
  draw_pure_translation(data.distance, "fig6_yaw_over_z", &StillSample::z_m,
                        "Figure 6: yaw of a person who only moves away", "distance in m", writer);
  std::vector<RunLine> lines;
  draw_runs(directory, data, lines, writer);
  if (!data.errors.empty()) {
    const auto curves = error_curves(data.errors);
    write_errors(curves, directory + "/errors_over_conditions.csv");
    writer.figure("errors_over_conditions.png", errors_over_conditions_figure(curves),
                  "Errors over distance, angle, blur, light and occlusion");
    writer.figure("errors_map.png", error_map_figure(data.errors), "Yaw error over distance and angle");
  }

  std::string summary = "# Experiments\n\n## Beside the paper\n\n" + paper_table(data) +
                        "\n## Goals of the design\n\n" + goals_table(data) + "\n";
  if (!lines.empty())
    summary +=
        "## Found, wrong, found again\n\nWhile the person walks; wrong: 15 degrees or a tenth of the "
        "distance off.\n\n" +
        run_table(lines) + "\n";
  std::vector<RunLine> without;
  for (const std::string& name : run_names(directory + "/without-pictures"))
    without.push_back(run_line(name, read_run(directory + "/without-pictures/" + name)));
  if (const std::string table = worlds_table(lines, without); !table.empty())
    summary += "## Both worlds on the same scenarios\n\n" + table + "\n";
  writer.figure("real_video.png", video_figure(directory), "Certainty over a real video");
  summary += real_section(directory) + "\n";
  summary += "## Figures\n\n" + writer.figures();
  std::ofstream file(directory + "/summary.md");
  file << summary;
  if (!file.flush()) throw Error(directory + "/summary.md: cannot write (expected a writable folder)");
  return summary;
}

}  // namespace heel::evaluation
