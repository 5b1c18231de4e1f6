#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "evaluation/benchmarks/printed.h"
#include "evaluation/benchmarks/vision_report.h"
#include "evaluation/reports/canvas.h"

namespace heel::evaluation {
namespace {


constexpr int kPictureWidth_px = 1100;
constexpr double kAreaLeft_px = 180, kAreaRight_px = 250, kAreaTop_px = 66;
constexpr double kRow_px = 48, kBar_px = 28;
constexpr double kTextSize = 0.42, kTitleSize = 0.56;
constexpr double kAxisSpare = 1.12;  // beyond the longest bar that is to be seen whole
const cv::Scalar kYardstickColour(165, 165, 165);
const cv::Scalar kGoalColour(40, 40, 220);

// In the order of VisionStage: features in blues, what is matched in oranges, geometry in greens.
const std::array<cv::Scalar, kVisionStages> kStageColours{
    cv::Scalar(90, 40, 10),    cv::Scalar(170, 80, 20),   cv::Scalar(205, 135, 70),
    cv::Scalar(230, 185, 130), cv::Scalar(40, 130, 230),  cv::Scalar(60, 60, 160),
    cv::Scalar(70, 120, 40),   cv::Scalar(130, 185, 245), cv::Scalar(135, 195, 120)};

const cv::Scalar& colour_of(VisionStage stage) {
  return kStageColours[static_cast<std::size_t>(stage)];
}

/// Of a path only its last part: a picture has no room for more.
std::string short_name(const std::string& source) {
  const std::filesystem::path path(source);
  return path.has_filename() ? path.filename() : path.parent_path().filename();
}

/// A row: a name, and a bar of stages or of one colour.
struct Row {
  std::string name;
  const Figure* figure = nullptr;
};

class Chart {
 public:
  Chart(const VisionReport& report, const std::vector<Row>& rows, double axis_ms)
      : bench_(report.bench),
        rows_(rows),
        axis_ms_(axis_ms),
        area_(kAreaLeft_px, kAreaTop_px, kPictureWidth_px - kAreaLeft_px - kAreaRight_px,
              kRow_px * static_cast<double>(rows.size())),
        canvas_(kPictureWidth_px, static_cast<int>(area_.br().y + kBelow_px)) {}

  cv::Mat draw(const std::string& title, const std::string& subtitle) {
    canvas_.text(title, {0.5 * kPictureWidth_px, 24}, kTitleSize, Canvas::Align::Centre, true);
    canvas_.text(subtitle, {0.5 * kPictureWidth_px, 46}, kTextSize, Canvas::Align::Centre);
    draw_axis();
    for (std::size_t i = 0; i < rows_.size(); ++i)
      draw_row(rows_[i], area_.y + kRow_px * (static_cast<double>(i) + 0.5));
    canvas_.box(area_, kInk);
    draw_stage_table();
    return canvas_.reduced();
  }

 private:
  static constexpr double kStageRow_px = 19;
  static constexpr double kBelow_px = 92 + kStageRow_px * static_cast<double>(kVisionStages);

  double x_of(double ms) const { return area_.x + ms / axis_ms_ * area_.width; }

  void draw_axis() {
    const double step_ms = nice_step(axis_ms_, 10);
    for (int i = 0; i * step_ms <= axis_ms_; ++i) {
      const double x = x_of(i * step_ms);
      canvas_.line({x, area_.y}, {x, area_.br().y}, kGrid, 0.5);
      canvas_.text(printed("%g", i * step_ms), {x, area_.br().y + 17}, kTextSize, Canvas::Align::Centre);
    }
    canvas_.text("thread CPU time in ms, median of the frames",
                 {area_.x + 0.5 * area_.width, area_.br().y + 38}, 0.46, Canvas::Align::Centre);
  }

  void draw_row(const Row& row, double y) {
    const Figure& figure = *row.figure;
    canvas_.text(row.name, {area_.x - 10, y + 5}, kTextSize, Canvas::Align::Right);
    if (figure.times.count == 0) {
      canvas_.text("in no frame", {area_.x + 8, y + 5}, kTextSize, Canvas::Align::Left);
      return;
    }
    draw_bar(figure, y);
    if (figure.goal) draw_goal(figure, y);
    canvas_.text(result_text(figure), {area_.br().x + 10, y + 5}, kTextSize, Canvas::Align::Left);
  }

  std::string result_text(const Figure& figure) const {
    std::string text = printed("%.1f ms", figure.times.median_ms);
    if (figure.key == "orb_1000") return text;
    text += printed(" = %.3g x ORB", bench_.ratio(figure.times, "orb_1000").value_or(NAN));
    return figure.goal ? text + printed(", goal %g", *figure.goal) : text;
  }

  /// The stages' shares of the frame's median; a bar longer than the axis is torn off.
  void draw_bar(const Figure& figure, double y) {
    const double top = y - 0.5 * kBar_px, whole_ms = figure.times.median_ms;
    const double end = x_of(std::min(whole_ms, axis_ms_));
    canvas_.bar({area_.x, top, end - area_.x, kBar_px}, kYardstickColour);
    double sum_ms = 0.0;
    for (const StageFigure& stage : figure.stages) sum_ms += stage.times.median_ms;
    double from_ms = 0.0;
    for (const StageFigure& stage : figure.stages) {
      const double to_ms = from_ms + stage.times.median_ms / sum_ms * whole_ms;
      canvas_.bar({x_of(from_ms), top, x_of(to_ms) - x_of(from_ms), kBar_px}, colour_of(stage.stage));
      from_ms = to_ms;
    }
    if (whole_ms > axis_ms_) tear(end, top);
  }

  void tear(double x, double top) {
    constexpr double kBack_px = 34, kSlant_px = 10, kGap_px = 6;
    canvas_.line({x - kBack_px, top + kBar_px}, {x - kBack_px + kSlant_px, top}, cv::Scalar::all(255),
                 kGap_px);
  }

  void draw_goal(const Figure& figure, double y) {
    const Figure* orb = bench_.find("orb_1000");
    const double x = x_of(*figure.goal * orb->times.median_ms);
    canvas_.line({x, y - 0.5 * kRow_px + 3}, {x, y + 0.5 * kRow_px - 3}, kGoalColour, 2.0);
  }

  /// Beneath the axis: what each stage takes, which is the bars' legend too.
  void draw_stage_table() {
    const std::array<double, 3> columns{300, 600, 740};
    double y = area_.br().y + 66;
    canvas_.line({area_.br().x + 20, y - 14}, {area_.br().x + 20, y + 6}, kGoalColour, 2.0);
    canvas_.text("goal", {area_.br().x + 30, y}, kTextSize, Canvas::Align::Left);
    canvas_.text("stage", {columns[0], y}, kTextSize, Canvas::Align::Left);
    for (std::size_t row = 0; row < 2; ++row)
      canvas_.text(rows_[row].name, {columns[row + 1], y}, kTextSize, Canvas::Align::Right);
    for (std::size_t i = 0; i < kVisionStages; ++i) {
      const auto stage = static_cast<VisionStage>(i);
      y += kStageRow_px;
      canvas_.bar({columns[0] - 24, y - 11, 15, 12}, colour_of(stage));
      canvas_.text(name_of(stage).label, {columns[0], y}, kTextSize, Canvas::Align::Left);
      for (std::size_t row = 0; row < 2; ++row)
        canvas_.text(stage_text(*rows_[row].figure, stage), {columns[row + 1], y}, kTextSize,
                     Canvas::Align::Right);
    }
  }

  static std::string stage_text(const Figure& figure, VisionStage stage) {
    for (const StageFigure& s : figure.stages)
      if (s.stage == stage) return printed("%.3f ms", s.times.median_ms);
    return "-";
  }

  const VisionBench& bench_;
  const std::vector<Row>& rows_;
  double axis_ms_;
  cv::Rect2d area_;
  Canvas canvas_;
};

}  // namespace

cv::Mat bars(const VisionReport& report) {
  const VisionBench& bench = report.bench;
  const std::vector<Row> rows{{"searching everywhere", bench.find("search")},
                              {"tracking", bench.find("tracking")},
                              {"features alone, 1000", bench.find("features")},
                              {"cv::ORB, 1000", bench.find("orb_1000")},
                              {"cv::AKAZE", bench.find("akaze")},
                              {"cv::SIFT", bench.find("sift")}};
  double axis_ms = 0.0;
  for (const char* key : {"search", "tracking", "features", "orb_1000"}) {
    const Figure& figure = *bench.find(key);
    const double goal_ms = figure.goal.value_or(0.0) * bench.find("orb_1000")->times.median_ms;
    axis_ms = std::max({axis_ms, figure.times.median_ms, goal_ms});
  }
  const std::string subtitle = printed("%zu frames of %d x %d, %s; one core, %s; all in turns on every frame",
                                       report.frames, report.size.width, report.size.height,
                                       short_name(report.source).c_str(), report.machine.cpu.c_str());
  return Chart(report, rows, kAxisSpare * axis_ms)
      .draw("From frame to pose, beside what OpenCV takes to find features", subtitle);
}

}  // namespace heel::evaluation
