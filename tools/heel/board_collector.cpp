#include "board_collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace heel::cli {
namespace {

// Shares of the picture's width, means over the corners.
constexpr double kStill = 0.004, kNew = 0.03;
// As of photographs: then the number of corners is right, and parts of a board are parts of this one.
constexpr std::size_t kWholeViewsBeforeParts = 2;

double mean_distance_px(const BoardView& a, const BoardView& b) {
  double sum_px = 0.0;
  for (std::size_t i = 0; i < a.corners_px.size(); ++i) sum_px += cv::norm(a.corners_px[i] - b.corners_px[i]);
  return sum_px / static_cast<double>(a.corners_px.size());
}

bool is_near(const BoardView& a, const BoardView& b, double distance_px) {
  return a.seen == b.seen && mean_distance_px(a, b) < distance_px;
}

}  // namespace

bool BoardCollector::is_still(const BoardView& view) const {
  return is_near(view, last_, kStill * image_size_.width);
}

bool BoardCollector::is_known(const BoardView& view) const {
  return std::ranges::any_of(
      views_, [&](const BoardView& kept) { return is_near(view, kept, kNew * image_size_.width); });
}

void BoardCollector::keep(const BoardView& view) {
  views_.push_back(view);
  views_.back().image = fmt::format("view {}", views_.size());
  whole_views_ += view.seen == board_.corners;
  for (const cv::Point2f& corner : view.corners_px) {
    const int column = static_cast<int>(3.f * corner.x / static_cast<float>(image_size_.width));
    const int row = static_cast<int>(3.f * corner.y / static_cast<float>(image_size_.height));
    covered_.at<std::uint8_t>(std::clamp(row, 0, 2), std::clamp(column, 0, 2)) = 255;
  }
}

BoardSeen BoardCollector::add(const cv::Mat& grey) {
  image_size_ = grey.size();
  FoundCorners found = find_corners(grey, board_);
  BoardView view{.image = {}, .corners_px = std::move(found.corners_px), .seen = found.seen};
  const bool is_part = view.seen != board_.corners;
  if (view.corners_px.empty() || (is_part && whole_views_ < kWholeViewsBeforeParts)) {
    last_ = {};
    return BoardSeen::None;
  }
  const bool still = is_still(view);
  last_ = view;
  if (!still) return BoardSeen::Moving;
  if (is_known(view)) return BoardSeen::Known;
  keep(view);
  return BoardSeen::Kept;
}

std::vector<std::string> coverage_lines(const cv::Mat& covered) {
  std::vector<std::string> lines;
  for (int row = 0; row < covered.rows; ++row) {
    std::string line;
    for (int column = 0; column < covered.cols; ++column)
      line += covered.at<std::uint8_t>(row, column) != 0 ? " #" : " .";
    lines.push_back(line);
  }
  return lines;
}

std::string parts_not_covered(const cv::Mat& covered) {
  constexpr std::array kNames = {"upper left", "upper middle", "upper right",  "left",       "middle",
                                 "right",      "lower left",   "lower middle", "lower right"};
  std::string parts;
  for (int i = 0; i < 9; ++i)
    if (covered.at<std::uint8_t>(i / 3, i % 3) == 0)
      parts += std::string(parts.empty() ? "" : ", ") + kNames[static_cast<std::size_t>(i)];
  return parts;
}

}  // namespace heel::cli
