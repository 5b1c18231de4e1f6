#include "vision/matching/feature_grid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace heel {
namespace {

constexpr int kMaxCells = 128;  // in a row and in a column
constexpr double kFarthest_px = 1e9;

}  // namespace

FeatureGrid::FeatureGrid(int max_features, double min_cell_px) : min_cell_px_(min_cell_px) {
  entries_.reserve(static_cast<std::size_t>(max_features));
  begin_.reserve(kMaxCells * kMaxCells + 1);
}

void FeatureGrid::assign(const FeatureSet& features, std::span<const Eigen::Vector2d> undistorted_px) {
  features_ = &features;
  undistorted_px_ = undistorted_px;
  // A lens model far outside its range may undistort to anything.
  const auto usable = [](const Eigen::Vector2d& px) {
    return px.allFinite() && px.cwiseAbs().maxCoeff() < kFarthest_px;
  };
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& px : undistorted_px)
    if (usable(px)) box.extend(px);
  if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
  origin_px_ = box.min();
  cell_px_ = std::max(min_cell_px_, box.sizes().maxCoeff() / (kMaxCells - 1));
  columns_ = static_cast<int>(box.sizes().x() / cell_px_) + 1;
  rows_ = static_cast<int>(box.sizes().y() / cell_px_) + 1;

  // A counting sort. The last feature is placed first, so that the features of a cell keep their order.
  begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  const auto cell_of = [&](const Eigen::Vector2d& px) { return cell(row_of(px.y()), column_of(px.x())); };
  for (const Eigen::Vector2d& px : undistorted_px)
    if (box.contains(px)) ++begin_[cell_of(px)];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  entries_.resize(static_cast<std::size_t>(begin_.back()));
  for (std::size_t i = undistorted_px.size(); i-- > 0;) {
    const Eigen::Vector2d& px = undistorted_px[i];
    if (!box.contains(px)) continue;
    const std::int32_t place = --begin_[cell_of(px)];
    entries_[static_cast<std::size_t>(place)] = {
        px.x(), px.y(), static_cast<double>(features.features[i].sigma_px), static_cast<std::int32_t>(i),
        features.features[i].laplacian};
  }
}

int FeatureGrid::column_of(double x_px) const {
  return static_cast<int>(std::clamp((x_px - origin_px_.x()) / cell_px_, 0.0, columns_ - 1.0));
}

int FeatureGrid::row_of(double y_px) const {
  return static_cast<int>(std::clamp((y_px - origin_px_.y()) / cell_px_, 0.0, rows_ - 1.0));
}

}  // namespace heel
