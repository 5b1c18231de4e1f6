#include "evaluation/benchmarks/printed.h"
#include "evaluation/benchmarks/vision_report.h"

namespace heel::evaluation {
namespace {

std::string times_columns(const Times& times) {
  if (times.count == 0) return printed("%9s %9s %9s", "-", "-", "-");
  return printed("%9.3f %9.3f %9.3f", times.min_ms, times.median_ms, times.p99_ms);
}

std::string ratio_columns(const VisionBench& bench, const Times& times, const std::string& yardstick) {
  const std::optional<double> ratio = bench.ratio(times, yardstick);
  return ratio ? printed("%8.3f", *ratio) : printed("%8s", "-");
}

std::string goal_columns(const VisionBench& bench, const Figure& figure) {
  const std::optional<double> ratio = bench.ratio(figure);
  if (!figure.goal) return "";
  return printed("  <= %-4g %s", *figure.goal,
                 !ratio                   ? "not measured"
                 : *ratio <= *figure.goal ? "reached"
                                          : "not reached");
}

std::string details(const VisionReport& report, const Figure& figure) {
  std::string text;
  if (figure.features) text += printed("%.0f features", *figure.features);
  if (!figure.stages.empty() && figure.times.count > 0)
    text += printed(", %.1f ns a pixel",
                    1e6 * figure.times.median_ms / figure.pixels.value_or(report.size.area()));
  if (figure.found_share) text += printed(", found in %.0f %%", 100.0 * *figure.found_share);
  if (figure.corner_error_px) text += printed("corner error %.2f px", *figure.corner_error_px);
  return text.empty() ? text : "  (" + text + ")";
}

std::string figure_lines(const VisionReport& report, const Figure& figure) {
  const VisionBench& bench = report.bench;
  std::string text = printed("%-38s", figure.label.c_str()) + times_columns(figure.times);
  if (!figure.yardstick.empty())
    text += ratio_columns(bench, figure.times, figure.yardstick) +
            printed(" x %-24s", figure.yardstick.c_str()) + goal_columns(bench, figure);
  text += details(report, figure) + "\n";
  for (const StageFigure& stage : figure.stages)
    text += printed("  %-36s", name_of(stage.stage).label) + times_columns(stage.times) +
            ratio_columns(bench, stage.times, figure.yardstick) + "\n";
  return text;
}

std::string model_lines(const VisionBench& bench) {
  if (bench.cost_models.empty()) return "";
  std::string text = printed(
      "\nCost models, times %.2f: cv::ORB(1000) here beside where they were measured\n%-38s%9s %17s %9s\n",
      bench.machine_scale, "", "measured", "model ms", "ratio");
  for (const CostModel& model : bench.cost_models) {
    const std::string range = model.low_ms < model.high_ms
                                  ? printed("%.3f to %.3f", model.low_ms, model.high_ms)
                                  : printed("%.3f", model.low_ms);
    text += printed("%-38s%9.3f %17s %9.2f\n", model.label.c_str(), model.measured_ms, range.c_str(),
                    model.ratio());
  }
  return text;
}

}  // namespace

std::string table(const VisionReport& report) {
  const VisionBench& bench = report.bench;
  const Machine& machine = report.machine;
  std::string text = printed("%s, %u cores, %s, OpenCV %s; load average %.1f, %.0f %% of a core had\n",
                             machine.cpu.c_str(), machine.cores, machine.simd.c_str(), machine.opencv.c_str(),
                             machine.load_1min, 100.0 * bench.cpu_share);
  text += printed("%zu frames of %d x %d, ", report.frames, report.size.width, report.size.height) +
          report.source +
          printed(": found in %.0f %%, tracked in %.0f %%; %u template features\n", 100.0 * bench.found_share,
                  100.0 * bench.tracked_share, bench.template_features);
  text += "Thread CPU time in ms, one core, all in turns on every frame; ratios are of medians.\n\n";
  text += printed("%-38s%9s %9s %9s%8s   %-24s  goal\n", "", "min", "median", "p99", "ratio", "yardstick");
  for (const Figure& figure : bench.figures) text += figure_lines(report, figure);
  text += "\n";
  for (const Figure& figure : bench.yardsticks) text += figure_lines(report, figure);
  return text + model_lines(bench);
}

}  // namespace heel::evaluation
