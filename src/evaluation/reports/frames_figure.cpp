// A contact sheet of kept frames with the quadrilateral the homography recovers.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "evaluation/reports/csv_table.h"
#include "evaluation/reports/figures.h"
#include "files/template_file.h"
#include "heel/shirt_template.h"

namespace heel::evaluation {
namespace {

constexpr std::size_t kColumns = 4;
constexpr std::size_t kMostTiles = 12;
constexpr int kTileWidth = 400;

/// The template's region carried into the frame; distorted pixels.
std::vector<cv::Point> quadrilateral(const ShirtTemplate& shirt, const CsvTable& poses, std::size_t row) {
  Eigen::Matrix3d H;
  for (int i = 0; i < 9; ++i) H(i / 3, i % 3) = poses.number(row, "H_cur_from_ref_" + std::to_string(i));
  const Region& roi = shirt.roi;
  const std::array<Eigen::Vector2d, 4> corners{
      Eigen::Vector2d(roi.x_px, roi.y_px), Eigen::Vector2d(roi.x_px + roi.width_px, roi.y_px),
      Eigen::Vector2d(roi.x_px + roi.width_px, roi.y_px + roi.height_px),
      Eigen::Vector2d(roi.x_px, roi.y_px + roi.height_px)};
  std::vector<cv::Point> out;
  for (const Eigen::Vector2d& corner : corners) {
    const Eigen::Vector3d p = H * shirt.camera.undistort_px(corner).homogeneous();
    const Eigen::Vector2d px = shirt.camera.distort_px(p.hnormalized());
    out.emplace_back(static_cast<int>(px.x()), static_cast<int>(px.y()));
  }
  return out;
}

cv::Mat tile(const cv::Mat& frame, const ShirtTemplate& shirt, const CsvTable& poses, std::size_t row) {
  cv::Mat out = frame.clone();
  char text[80] = "not found";
  if (poses.number(row, "found") != 0.0) {
    cv::polylines(out, quadrilateral(shirt, poses, row), true, cv::Scalar(60, 220, 60), 3, cv::LINE_AA);
    std::snprintf(text, sizeof text, "yaw %+.1f deg   certainty %.2f",
                  57.29578 * poses.number(row, "yaw_rad"), poses.number(row, "certainty"));
  }
  cv::rectangle(out, {0, out.rows - 34}, {out.cols, out.rows}, cv::Scalar::all(0), cv::FILLED);
  cv::putText(out, text, {10, out.rows - 10}, cv::FONT_HERSHEY_SIMPLEX, 0.7, cv::Scalar::all(255), 2,
              cv::LINE_AA);
  cv::resize(out, out, {kTileWidth, kTileWidth * frame.rows / frame.cols}, 0, 0, cv::INTER_AREA);
  cv::copyMakeBorder(out, out, 2, 2, 2, 2, cv::BORDER_CONSTANT, cv::Scalar::all(255));
  return out;
}

struct KeptFrame {
  std::filesystem::path file;
  std::size_t row;  ///< of poses.csv
};

/// Whole pictures of the template's size which the vision stage has seen, in order. A run that was cut short
/// may leave half a picture.
std::vector<KeptFrame> usable_frames(const std::string& directory, const CsvTable& poses,
                                     const CameraModel& camera) {
  std::map<unsigned long long, std::size_t> row_of;
  for (std::size_t i = 0; i < poses.rows(); ++i)
    row_of[static_cast<unsigned long long>(poses.number(i, "frame"))] = i;
  std::vector<KeptFrame> frames;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    const auto row = row_of.find(std::strtoull(entry.path().stem().c_str(), nullptr, 10));
    if (row == row_of.end()) continue;
    const cv::Mat picture = cv::imread(entry.path().string(), cv::IMREAD_COLOR);
    if (picture.cols == camera.width_px && picture.rows == camera.height_px)
      frames.push_back({entry.path(), row->second});
  }
  std::sort(frames.begin(), frames.end(),
            [](const KeptFrame& a, const KeptFrame& b) { return a.row < b.row; });
  return frames;
}

/// As many of them as fill whole rows, evenly spread, the first and the last among them.
std::vector<KeptFrame> chosen_frames(const std::vector<KeptFrame>& frames) {
  const std::size_t rows = std::min(frames.size(), kMostTiles) / kColumns;
  const std::size_t wanted = rows > 0 ? rows * kColumns : frames.size();
  if (wanted < 2) return frames;
  std::vector<KeptFrame> chosen;
  for (std::size_t i = 0; i < wanted; ++i)
    chosen.push_back(frames[(2 * i * (frames.size() - 1) + wanted - 1) / (2 * (wanted - 1))]);
  return chosen;
}

}  // namespace

cv::Mat frames_figure(const std::string& directory) {
  namespace fs = std::filesystem;
  if (!fs::is_directory(directory + "/frames") || !fs::exists(directory + "/shirt.heel")) return {};
  const ShirtTemplate shirt = read_template(directory + "/shirt.heel");
  const CsvTable poses(directory + "/poses.csv");
  std::vector<cv::Mat> tiles;
  for (const KeptFrame& kept : chosen_frames(usable_frames(directory + "/frames", poses, shirt.camera)))
    tiles.push_back(tile(cv::imread(kept.file.string(), cv::IMREAD_COLOR), shirt, poses, kept.row));
  if (tiles.empty()) return {};
  const std::size_t columns = std::min(kColumns, tiles.size());
  std::vector<cv::Mat> rows(tiles.size() / columns);
  for (std::size_t i = 0; i < rows.size(); ++i) cv::hconcat(&tiles[i * columns], columns, rows[i]);
  cv::Mat sheet;
  cv::vconcat(rows, sheet);
  return sheet;
}

}  // namespace heel::evaluation
