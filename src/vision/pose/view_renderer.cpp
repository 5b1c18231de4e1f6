#include "vision/pose/view_renderer.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "vision/patches/grey_pyramid.h"

namespace heel {
namespace {

constexpr int kViewMargin_px = 24;  // round the region: as far as descriptors reach
// Sub-samples of a pixel, more of them across, where a turned view is compressed.
constexpr double kSampleRows_px[] = {-0.25, 0.25}, kSampleColumns_px[] = {-0.375, -0.125, 0.125, 0.375};

/// A place of the reference view, and where the template's picture shows it.
struct Place {
  Eigen::Vector2d ref_px;
  Eigen::Vector2d source_px;  // with the lens distortion
};

/// Renders a view in square cells. Newton's method solves a cell's corners and its middle; where the mapping
/// is nearly bilinear, its other pixels are interpolated. At the edge of the visible back each pixel is
/// solved.
class ViewRenderer {
 public:
  ViewRenderer(const ShirtTemplate& shirt, const ViewGeometry& geometry, double scale)
      : camera_(shirt.camera),
        geometry_(geometry),
        reference_(shirt.grey, shirt.camera.width_px, shirt.camera.height_px),
        level_(static_cast<std::size_t>(
            std::clamp(-std::lround(std::log2(scale)), 0L, static_cast<long>(GreyPyramid::kLevels) - 1))) {}

  /// Pixels that do not show the back stay 0.
  RenderedView render() {
    const Eigen::AlignedBox2d box = geometry_.visible_box();
    RenderedView view;
    if (box.isEmpty()) return view;
    view.origin_px = box.min().array().floor() - kViewMargin_px;
    view.width_px = static_cast<int>(std::ceil(box.sizes().x())) + 2 * kViewMargin_px;
    view.height_px = static_cast<int>(std::ceil(box.sizes().y())) + 2 * kViewMargin_px;
    view.grey.resize(view.index(0, view.height_px));
    view.ref_px.resize(view.grey.size());
    solve_corners(view);
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column) render_cell(row, column, view);
    return view;
  }

 private:
  static constexpr int kCell_px = 4;
  static constexpr double kBilinear_px =
      0.05;  // of the reference view: largest error of an interpolated place

  struct Cell {
    const std::optional<Place>&top_left, &top_right, &bottom_left, &bottom_right;

    bool complete() const { return top_left && top_right && bottom_left && bottom_right; }
    const std::optional<Place>& any() const {
      return top_left ? top_left : top_right ? top_right : bottom_left ? bottom_left : bottom_right;
    }
    Eigen::Vector2d at(Eigen::Vector2d Place::*px, double x, double y) const {
      return (1.0 - y) * ((1.0 - x) * (*top_left).*px + x * (*top_right).*px) +
             y * ((1.0 - x) * (*bottom_left).*px + x * (*bottom_right).*px);
    }
    /// d source px / d view px, mean of the cell.
    Eigen::Matrix2d source_from_view() const {
      Eigen::Matrix2d D;
      D.col(0) = at(&Place::source_px, 1.0, 0.5) - at(&Place::source_px, 0.0, 0.5);
      D.col(1) = at(&Place::source_px, 0.5, 1.0) - at(&Place::source_px, 0.5, 0.0);
      return D / kCell_px;
    }
  };

  std::optional<Place>& corner(int row, int column) {
    return corners_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_ + 1) +
                    static_cast<std::size_t>(column)];
  }
  Cell cell(int row, int column) {
    return {corner(row, column), corner(row, column + 1), corner(row + 1, column),
            corner(row + 1, column + 1)};
  }

  std::optional<Place> solve(const Eigen::Vector2d& view_px, const Eigen::Vector2d& start_px) const {
    const std::optional<Eigen::Vector2d> ref_px = geometry_.place_shown(view_px, start_px);
    if (!ref_px) return std::nullopt;
    return Place{*ref_px, camera_.distort_px(*ref_px)};
  }

  void solve_corners(const RenderedView& view) {
    columns_ = (view.width_px + kCell_px - 1) / kCell_px;
    rows_ = (view.height_px + kCell_px - 1) / kCell_px;
    corners_.assign(static_cast<std::size_t>(rows_ + 1) * static_cast<std::size_t>(columns_ + 1),
                    std::nullopt);
    const Eigen::Vector2d middle_px = geometry_.ref_px(0.0, 0.0);
    for (int row = 0; row <= rows_; ++row) {
      for (int column = 0; column <= columns_; ++column) {
        Eigen::Vector2d start_px = middle_px;  // or what a neighbour shows
        if (column > 0 && corner(row, column - 1)) {
          start_px = corner(row, column - 1)->ref_px;
        } else if (row > 0 && corner(row - 1, column)) {
          start_px = corner(row - 1, column)->ref_px;
        }
        corner(row, column) = solve(view.origin_px + kCell_px * Eigen::Vector2d(column, row), start_px);
      }
    }
  }

  bool nearly_bilinear(const Cell& cell, const Eigen::Vector2d& middle_view_px) const {
    if (!cell.complete()) return false;
    const Eigen::Vector2d middle_px = cell.at(&Place::ref_px, 0.5, 0.5);
    const std::optional<Eigen::Vector2d> solved_px = geometry_.place_shown(middle_view_px, middle_px);
    return solved_px && (*solved_px - middle_px).norm() < kBilinear_px;
  }

  void render_cell(int row, int column, RenderedView& view) {
    const Cell corners = cell(row, column);
    if (!corners.any()) return;
    const Eigen::Vector2d origin_px = kCell_px * Eigen::Vector2d(column, row);
    const bool bilinear =
        nearly_bilinear(corners, view.origin_px + origin_px + Eigen::Vector2d::Constant(kCell_px / 2.0));
    const Eigen::Matrix2d D = bilinear ? corners.source_from_view() : Eigen::Matrix2d::Zero();
    const int x_end = std::min((column + 1) * kCell_px, view.width_px);
    const int y_end = std::min((row + 1) * kCell_px, view.height_px);
    for (int y = row * kCell_px; y < y_end; ++y) {
      for (int x = column * kCell_px; x < x_end; ++x) {
        const Eigen::Vector2d in_cell = (Eigen::Vector2d(x, y) - origin_px) / kCell_px;
        if (bilinear) {
          set_pixel(view, view.index(x, y),
                    {corners.at(&Place::ref_px, in_cell.x(), in_cell.y()),
                     corners.at(&Place::source_px, in_cell.x(), in_cell.y())},
                    D);
        } else if (const auto place = solve(view.origin_px + Eigen::Vector2d(x, y), corners.any()->ref_px)) {
          set_pixel(view, view.index(x, y), *place, source_from_view(*place));
        }
      }
    }
  }

  Eigen::Matrix2d source_from_view(const Place& place) const {
    const Eigen::Matrix2d ref_from_view = geometry_.derivative(place.ref_px).inverse();
    Eigen::Matrix2d D;
    for (int i = 0; i < 2; ++i)
      D.col(i) = camera_.distort_px(place.ref_px + ref_from_view.col(i)) - place.source_px;
    return D;
  }

  /// The mean of the pixel's part of the reference picture.
  void set_pixel(RenderedView& view, std::size_t index, const Place& place,
                 const Eigen::Matrix2d& source_from_view) const {
    float sum = 0.f;
    for (const double dy_px : kSampleRows_px)
      for (const double dx_px : kSampleColumns_px)
        sum += reference_.at(place.source_px + source_from_view * Eigen::Vector2d(dx_px, dy_px), level_);
    const float mean = sum / static_cast<float>(std::size(kSampleRows_px) * std::size(kSampleColumns_px));
    view.ref_px[index] = place.ref_px;
    view.grey[index] = static_cast<std::uint8_t>(std::clamp(mean + 0.5f, 0.f, 255.f));
  }

  const CameraModel& camera_;
  const ViewGeometry& geometry_;
  GreyPyramid reference_;
  std::size_t level_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::optional<Place>> corners_;  // of all cells
};

/// Beside the back each row has the level of the back's edge, so that the edge makes no feature: the
/// background of later frames is unknown.
void extend_edges(RenderedView& view) {
  for (int y = 0; y < view.height_px; ++y) {
    int first = -1, last = -1;
    for (int x = 0; x < view.width_px; ++x) {
      if (!view.ref_px[view.index(x, y)]) continue;
      if (first < 0) first = x;
      last = x;
    }
    for (int x = 0; first >= 0 && x < view.width_px; ++x)
      if (!view.ref_px[view.index(x, y)])
        view.grey[view.index(x, y)] = view.grey[view.index(x < first ? first : last, y)];
  }
}

/// Where the back is not visible: the mean level beside and between rows that show it.
void fill_background(RenderedView& view) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < view.grey.size(); ++i) {
    if (!view.ref_px[i]) continue;
    sum += view.grey[i];
    count += 1.0;
  }
  const auto mean = static_cast<std::uint8_t>(count > 0.0 ? sum / count : 0.0);
  for (std::size_t i = 0; i < view.grey.size(); ++i)
    if (!view.ref_px[i]) view.grey[i] = mean;
  extend_edges(view);
}

}  // namespace

RenderedView render_view(const ShirtTemplate& shirt, const ViewGeometry& geometry, double scale) {
  RenderedView view = ViewRenderer(shirt, geometry, scale).render();
  fill_background(view);
  return view;
}

}  // namespace heel
