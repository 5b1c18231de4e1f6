#include "vision/matching/guided_matcher.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace heel {
namespace {

constexpr int kMostCells = 128;  // either way
constexpr double kFarthest_px = 1e9;

float squared_distance(const Descriptor& a, const Descriptor& b) {
  const Eigen::Map<const Eigen::Matrix<float, kDescriptorSize, 1>> u(a.data()), v(b.data());
  return (u - v).squaredNorm();
}

}  // namespace

GuidedMatcher::GuidedMatcher(int max_cur, const GuidedMatchSettings& settings) : settings_(settings) {
  candidates_.reserve(static_cast<std::size_t>(max_cur));
  taken_by_.reserve(static_cast<std::size_t>(max_cur));
  begin_.reserve(kMostCells * kMostCells + 1);
}

void GuidedMatcher::look_at(const FeatureSet& cur, std::span<const Eigen::Vector2d> cur_px) {
  cur_ = &cur;
  taken_by_.resize(cur_px.size());
  // A lens model far outside its range may undistort to anything.
  const auto somewhere = [](const Eigen::Vector2d& px) { return px.cwiseAbs().maxCoeff() < kFarthest_px; };
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& px : cur_px)
    if (px.allFinite() && somewhere(px)) box.extend(px);
  if (box.isEmpty()) box.extend(Eigen::Vector2d::Zero());
  origin_px_ = box.min();
  cell_px_ = std::max(settings_.radius_px, box.sizes().maxCoeff() / (kMostCells - 1));
  columns_ = static_cast<int>(box.sizes().x() / cell_px_) + 1;
  rows_ = static_cast<int>(box.sizes().y() / cell_px_) + 1;

  // Counted, then put in place from the last, so that features of a cell stay in their order.
  begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 1, 0);
  const auto cell_of = [&](const Eigen::Vector2d& px) {
    return static_cast<std::size_t>(row_of(px.y()) * columns_ + column_of(px.x()));
  };
  for (const Eigen::Vector2d& px : cur_px)
    if (box.contains(px)) ++begin_[cell_of(px)];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  candidates_.resize(static_cast<std::size_t>(begin_.back()));
  for (std::size_t i = cur_px.size(); i-- > 0;) {
    if (!box.contains(cur_px[i])) continue;
    const std::int32_t place = --begin_[cell_of(cur_px[i])];
    candidates_[static_cast<std::size_t>(place)] = {cur_px[i].x(), cur_px[i].y(),
                                                    static_cast<double>(cur.features[i].sigma_px),
                                                    static_cast<std::int32_t>(i), cur.features[i].laplacian};
  }
}

int GuidedMatcher::column_of(double x_px) const {
  return static_cast<int>(std::clamp((x_px - origin_px_.x()) / cell_px_, 0.0, columns_ - 1.0));
}

int GuidedMatcher::row_of(double y_px) const {
  return static_cast<int>(std::clamp((y_px - origin_px_.y()) / cell_px_, 0.0, rows_ - 1.0));
}

GuidedMatcher::Cells GuidedMatcher::cells_near(const Eigen::Vector2d& px) const {
  const double r = settings_.radius_px;
  return {column_of(px.x() - r), row_of(px.y() - r), column_of(px.x() + r), row_of(px.y() + r)};
}

void GuidedMatcher::match(std::span<const PredictedView> predicted, const FeatureSet& ref,
                          std::vector<Match>& out) {
  std::fill(taken_by_.begin(), taken_by_.end(), -1);
  out.clear();
  const double radius2_px2 = settings_.radius_px * settings_.radius_px;

  for (std::size_t r = 0; r < ref.features.size(); ++r) {
    const Eigen::Vector2d& predicted_px = predicted[r].px;
    if (!(predicted[r].scale > 0.0) || !predicted_px.allFinite()) continue;
    const double predicted_sigma = static_cast<double>(ref.features[r].sigma_px) * predicted[r].scale;
    const double smallest_sigma = predicted_sigma / settings_.scale_ratio;
    const double largest_sigma = predicted_sigma * settings_.scale_ratio;
    float nearest2 = std::numeric_limits<float>::infinity(), second2 = nearest2;
    std::size_t nearest = 0;
    const auto consider = [&](const Candidate& candidate) {
      if (candidate.laplacian != ref.features[r].laplacian) return;
      const double dx_px = candidate.x_px - predicted_px.x(), dy_px = candidate.y_px - predicted_px.y();
      if (!(dx_px * dx_px + dy_px * dy_px < radius2_px2)) return;
      if (candidate.sigma_px < smallest_sigma || candidate.sigma_px > largest_sigma) return;
      const auto c = static_cast<std::size_t>(candidate.index);
      const float distance2 = squared_distance(ref.descriptors[r], cur_->descriptors[c]);
      if (distance2 < nearest2) {
        second2 = nearest2;
        nearest2 = distance2;
        nearest = c;
      } else {
        second2 = std::min(second2, distance2);
      }
    };
    const Cells near = cells_near(predicted_px);
    for (int row = near.top; row <= near.bottom; ++row) {
      const auto cell = static_cast<std::size_t>(row * columns_);
      const auto first = static_cast<std::size_t>(begin_[cell + static_cast<std::size_t>(near.left)]);
      const auto end = static_cast<std::size_t>(begin_[cell + static_cast<std::size_t>(near.right) + 1]);
      for (std::size_t i = first; i < end; ++i) consider(candidates_[i]);
    }
    const float limit = settings_.max_distance;
    if (!(nearest2 < limit * limit) || nearest2 > settings_.ratio * settings_.ratio * second2) continue;
    const Match match{static_cast<std::int32_t>(r), static_cast<std::int32_t>(nearest), std::sqrt(nearest2)};
    std::int32_t& owner = taken_by_[nearest];
    if (owner < 0) {
      owner = static_cast<std::int32_t>(out.size());
      out.push_back(match);
    } else if (match.distance < out[static_cast<std::size_t>(owner)].distance) {
      out[static_cast<std::size_t>(owner)] = match;
    }
  }
}

}  // namespace heel
