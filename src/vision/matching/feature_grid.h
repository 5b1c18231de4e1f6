// A frame's features sorted by place: a search near a predicted place reads only those around it.
//
// Units: places are undistorted pixels of the frame.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "heel/features.h"

namespace heel {

class FeatureGrid {
 public:
  /// What is compared first of a frame feature, before its descriptor.
  struct Entry {
    double x_px, y_px;
    double sigma_px;
    std::int32_t index;  ///< in features()
    std::int8_t laplacian;
  };

  /// Takes memory for `max_features` features once. No cell is smaller than `min_cell_px`.
  FeatureGrid(int max_features, double min_cell_px);

  /// Sorts a frame's features, `undistorted_px` being their places in the same order. Both must outlive their
  /// use here. A feature whose place is not finite, or absurdly far away, is in no cell.
  void assign(const FeatureSet& features, std::span<const Eigen::Vector2d> undistorted_px);

  const FeatureSet& features() const { return *features_; }
  std::span<const Eigen::Vector2d> undistorted_px() const { return undistorted_px_; }

  /// Calls `visit(const Entry&)` for every feature in the cells that a circle touches: those inside the
  /// circle and some outside it, always in the same order. `centre_px` must be finite.
  template <typename Visitor>
  void visit_near(const Eigen::Vector2d& centre_px, double radius_px, Visitor&& visit) const {
    const int left = column_of(centre_px.x() - radius_px), right = column_of(centre_px.x() + radius_px);
    const int top = row_of(centre_px.y() - radius_px), bottom = row_of(centre_px.y() + radius_px);
    for (int row = top; row <= bottom; ++row) {
      const auto first = static_cast<std::size_t>(begin_[cell(row, left)]);
      const auto end = static_cast<std::size_t>(begin_[cell(row, right) + 1]);
      for (std::size_t i = first; i < end; ++i) visit(entries_[i]);
    }
  }

 private:
  int column_of(double x_px) const;
  int row_of(double y_px) const;
  std::size_t cell(int row, int column) const { return static_cast<std::size_t>(row * columns_ + column); }

  double min_cell_px_;
  const FeatureSet* features_ = nullptr;
  std::span<const Eigen::Vector2d> undistorted_px_;
  // Row by row: cell i holds entries begin_[i] to begin_[i + 1].
  std::vector<Entry> entries_;
  std::vector<std::int32_t> begin_;
  Eigen::Vector2d origin_px_ = Eigen::Vector2d::Zero();
  double cell_px_ = 1.0;
  int columns_ = 0, rows_ = 0;
};

}  // namespace heel
