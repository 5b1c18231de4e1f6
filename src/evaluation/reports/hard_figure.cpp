// Figure 1: the recovered quadrilateral on the shirt in hard cases.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "evaluation/reports/csv_table.h"
#include "evaluation/reports/paper_figures.h"
#include "evaluation/reports/style.h"
#include "heel/error.h"

namespace heel::evaluation {
namespace {

constexpr int kHardColumns = 4;
constexpr int kHardTileWidth_px = 264;
constexpr int kCornerShift = 4;  ///< OpenCV's fixed-point places

cv::Mat hard_tile(const cv::Mat& grey, const CsvTable& table, std::size_t row) {
  cv::Mat out;
  cv::cvtColor(grey, out, cv::COLOR_GRAY2BGR);
  const bool found = table.number(row, "found") != 0.0;
  char values[96];
  std::snprintf(values, sizeof values, "not found: %s", table.text(row, "reason").c_str());
  if (found) {
    std::vector<cv::Point> corners;
    for (int i = 0; i < 4; ++i) {
      const std::string corner = "corner_" + std::to_string(i);
      corners.emplace_back(cvRound(table.number(row, corner + "_x_px") * (1 << kCornerShift)),
                           cvRound(table.number(row, corner + "_y_px") * (1 << kCornerShift)));
    }
    cv::polylines(out, corners, true, cv::Scalar(60, 220, 60), 3, cv::LINE_AA, kCornerShift);
    std::snprintf(values, sizeof values, "yaw %+.0f (true %+.0f) deg, certainty %.2f",
                  kDeg * table.number(row, "est_yaw_rad"), kDeg * table.number(row, "true_yaw_rad"),
                  table.number(row, "certainty"));
  }
  cv::rectangle(out, {0, out.rows - 66}, {out.cols, out.rows}, cv::Scalar::all(0), cv::FILLED);
  const cv::Scalar ink = found ? cv::Scalar::all(255) : cv::Scalar(120, 160, 255);
  cv::putText(out, table.text(row, "name"), {12, out.rows - 40}, cv::FONT_HERSHEY_SIMPLEX, 0.85, ink, 2,
              cv::LINE_AA);
  cv::putText(out, values, {12, out.rows - 12}, cv::FONT_HERSHEY_SIMPLEX, 0.8, ink, 2, cv::LINE_AA);
  cv::resize(out, out, {kHardTileWidth_px, kHardTileWidth_px * grey.rows / grey.cols}, 0, 0, cv::INTER_AREA);
  cv::copyMakeBorder(out, out, 2, 2, 2, 2, cv::BORDER_CONSTANT, cv::Scalar::all(255));
  return out;
}

}  // namespace

cv::Mat hard_figure(const std::string& directory) {
  if (!std::filesystem::exists(directory + "/hard.csv")) return {};
  const CsvTable table(directory + "/hard.csv");
  std::vector<cv::Mat> tiles;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (table.number(row, "picture") != 1.0) continue;  // the second picture of a case is the one kept
    char name[32];
    std::snprintf(name, sizeof name, "/hard/%03zu.png", tiles.size());
    const cv::Mat grey = cv::imread(directory + name, cv::IMREAD_GRAYSCALE);
    if (grey.empty())
      throw Error(directory + name + ": cannot read (expected the picture of " + table.place(row) + ")");
    tiles.push_back(hard_tile(grey, table, row));
  }
  if (tiles.empty()) return {};
  while (tiles.size() % kHardColumns != 0)
    tiles.emplace_back(tiles.front().size(), CV_8UC3, cv::Scalar::all(255));
  std::vector<cv::Mat> rows(tiles.size() / kHardColumns);
  for (std::size_t i = 0; i < rows.size(); ++i) cv::hconcat(&tiles[i * kHardColumns], kHardColumns, rows[i]);
  cv::Mat sheet;
  cv::vconcat(rows, sheet);
  return sheet;
}

}  // namespace heel::evaluation
