#include "evaluation/reports/experiment_report.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/angles.h"
#include "evaluation/reports/error_statistics.h"
#include "evaluation/reports/foreign_report.h"
#include "evaluation/reports/paper_comparison.h"
#include "evaluation/reports/paper_numbers.h"
#include "evaluation/reports/real_report.h"
#include "evaluation/reports/run_files.h"
#include "evaluation/reports/summary_part.h"
#include "files/atomic_file.h"

namespace heel::evaluation {
namespace {

namespace fs = std::filesystem;

/// The figures of a folder: the numbers of each in its own file, and all of them in the summary.
class Figures {
 public:
  explicit Figures(std::string directory) : directory_(std::move(directory)) {}

  void add(const std::string& name, const std::string& caption) {
    links_ += "![" + caption + "](" + name + ")\n\n";
  }
  void add_steps(const std::string& name, const std::vector<Step>& steps, const std::string& unit,
                 const std::string& caption) {
    write_steps(steps, unit, directory_ + "/" + name + ".csv");
    add(name + ".png", caption);
  }
  const std::string& directory() const { return directory_; }
  const std::string& links() const { return links_; }

 private:
  std::string directory_;
  std::string links_;
};

std::vector<StillSample> stills_if_any(const std::string& path) {
  return fs::exists(path) ? read_stills(path) : std::vector<StillSample>{};
}

void add_stills(const ExperimentData& data, Figures& figures) {
  using S = StillSample;
  if (!data.lateral.empty())
    figures.add_steps("fig2_t_x", steps_of(data.lateral, &S::x_m, &S::x_est_m, &S::true_x_m), "m",
                      "Figure 2: t_x at sideways offsets, 2 m away");
  if (!data.distance.empty())
    figures.add_steps("fig3_t_z", steps_of(data.distance, &S::z_m, &S::z_est_m, &S::true_z_m), "m",
                      "Figure 3: t_z over the distance");
  if (!data.yaw.empty())
    figures.add_steps("fig4_yaw",
                      steps_of(data.yaw, &S::yaw_rad, &S::yaw_est_rad, &S::true_yaw_rad, kDegPerRad), "deg",
                      "Figure 4: yaw of the back, 2 m away");
}

/// The yaw of a person who does not turn, over where they are: Figures 5 and 6.
void add_pure_translation(const std::vector<StillSample>& samples, const std::string& name, Member place,
                          const std::string& caption, Figures& figures) {
  if (samples.empty()) return;
  // Degrees for the estimate, metres for the place.
  std::vector<StillSample> in_degrees = samples;
  for (StillSample& sample : in_degrees) {
    sample.yaw_est_rad *= kDegPerRad;
    sample.true_yaw_rad *= kDegPerRad;
  }
  figures.add_steps(name, steps_of(in_degrees, place, &StillSample::yaw_est_rad, &StillSample::true_yaw_rad),
                    "deg", caption);
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

void add_runs(ExperimentData& data, std::vector<RunLine>& lines, Figures& figures) {
  std::optional<MetricsCollector> walk, position_only;
  for (const std::string& name : run_names(figures.directory() + "/runs")) {
    const MetricsCollector run = read_run(figures.directory() + "/runs/" + name);
    lines.push_back(run_line(name, run));
    if (name == "response") {
      write_response(figures.directory(), run);
      figures.add("fig7_response.png", "Figure 7: the robot's response to an offset line at another heading");
    }
    if (name == "walk") {
      walk = run;
      data.walk = lines.back();
    }
    if (name == "walk-position-only") {
      position_only = run;
      data.walk_position_only = lines.back();
    }
  }
  if (!walk) return;
  write_walk(figures.directory(), *walk, position_only ? &*position_only : nullptr);
  figures.add("fig8_walk.png", "Figure 8: both paths of a long walk");
}

/// The parts in marks, by which tools/experiments-page finds them.
std::string summary_of(const std::vector<SummaryPart>& parts) {
  std::string text = "# Experiments\n";
  for (const SummaryPart& part : parts)
    text += "\n## " + part.heading + "\n\n<!-- " + part.name + " -->\n\n" + part.text + "\n<!-- end of " +
            part.name + " -->\n";
  return text;
}

void add_errors(const std::vector<StillSample>& samples, Figures& figures) {
  if (samples.empty()) return;
  write_errors(error_curves(samples), figures.directory() + "/errors_over_conditions.csv");
  write_error_map(samples, figures.directory() + "/errors_map.csv");
  figures.add("errors_over_conditions.png", "Errors over distance, angle, blur, light and occlusion");
  figures.add("errors_map.png", "Yaw error over distance and angle");
}

}  // namespace

bool holds_experiments(const std::string& directory) {
  for (const char* name : {"lateral", "distance", "yaw", "hard", "errors", "foreign"})
    if (fs::exists(directory + "/" + name + ".csv")) return true;
  return !run_names(directory + "/runs").empty();
}

std::string report_experiments(const std::string& directory) {
  Figures figures(directory);
  ExperimentData data;
  data.lateral = stills_if_any(directory + "/lateral.csv");
  data.distance = stills_if_any(directory + "/distance.csv");
  data.yaw = stills_if_any(directory + "/yaw.csv");
  data.errors = stills_if_any(directory + "/errors.csv");

  if (fs::exists(directory + "/hard.csv"))
    figures.add("fig1_hard.jpg", "Figure 1: the shirt found in twelve hard cases");
  add_stills(data, figures);
  add_pure_translation(data.lateral, "fig5_yaw_over_x", &StillSample::x_m,
                       "Figure 5: yaw of a person who only moves sideways", figures);
  add_pure_translation(data.distance, "fig6_yaw_over_z", &StillSample::z_m,
                       "Figure 6: yaw of a person who only moves away", figures);
  std::vector<RunLine> lines;
  add_runs(data, lines, figures);
  add_errors(data.errors, figures);
  if (fs::exists(directory + "/real_video.csv")) figures.add("real_video.png", "Certainty over a real video");

  std::vector<SummaryPart> parts = foreign_parts(directory, data.errors);
  if (fs::exists(directory + "/foreign_sigma.csv"))
    figures.add("foreign_reliability.png", "Right poses over the certainty, errors over the stated sigma");
  const bool own_world = !data.all_stills().empty() || !lines.empty();
  if (own_world) {
    parts.push_back({"paper", "Beside the paper", paper_table(data)});
    parts.push_back({"goals", "Goals of the design", goals_table(data)});
  }
  if (!lines.empty())
    parts.push_back(
        {"runs", "Found, wrong, found again",
         "While the person walks; wrong: 15 degrees or a tenth of the distance off.\n\n" + run_table(lines)});
  std::vector<RunLine> without;
  const fs::path folder = fs::path(directory) / "without-pictures";
  for (const std::string& name : run_names(folder.string()))
    without.push_back(run_line(name, read_run((folder / name).string())));
  if (const std::string table = worlds_table(lines, without); !table.empty())
    parts.push_back({"worlds", "Both worlds on the same scenarios", table});
  if (own_world) parts.push_back({"real", "Real pictures", real_text(directory)});
  parts.push_back({"figures", "Figures", figures.links()});
  std::string summary = summary_of(parts);
  write_file_atomically(directory + "/summary.md", summary);
  return summary;
}

}  // namespace heel::evaluation
