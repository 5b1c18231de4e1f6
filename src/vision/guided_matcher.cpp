#include "guided_matcher.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "shape_plausibility.h"

namespace heel {
namespace {

float squared_distance(const Descriptor& a, const Descriptor& b) {
  const Eigen::Map<const Eigen::Matrix<float, kDescriptorSize, 1>> u(a.data()), v(b.data());
  return (u - v).squaredNorm();
}

}  // namespace

GuidedMatcher::GuidedMatcher(int max_cur, const GuidedMatchSettings& settings) : settings_(settings) {
  by_row_.reserve(static_cast<std::size_t>(max_cur));
  row_px_.reserve(static_cast<std::size_t>(max_cur));
  taken_by_.reserve(static_cast<std::size_t>(max_cur));
}

void GuidedMatcher::sort_by_row(std::span<const Eigen::Vector2d> cur_px) {
  by_row_.clear();
  for (std::size_t i = 0; i < cur_px.size(); ++i) by_row_.push_back(static_cast<std::int32_t>(i));
  std::sort(by_row_.begin(), by_row_.end(), [&](std::int32_t a, std::int32_t b) {
    const double ya = cur_px[static_cast<std::size_t>(a)].y(), yb = cur_px[static_cast<std::size_t>(b)].y();
    return ya < yb || (ya == yb && a < b);
  });
  row_px_.clear();
  for (const std::int32_t i : by_row_) row_px_.push_back(cur_px[static_cast<std::size_t>(i)].y());
}

void GuidedMatcher::match(const Eigen::Matrix3d& H_cur_from_ref, const FeatureSet& ref,
                          std::span<const Eigen::Vector2d> ref_px, const FeatureSet& cur,
                          std::span<const Eigen::Vector2d> cur_px, std::vector<Match>& out) {
  sort_by_row(cur_px);
  taken_by_.assign(cur_px.size(), -1);
  out.clear();
  const double log_scale_ratio = std::log(settings_.scale_ratio);
  const double radius2_px2 = settings_.radius_px * settings_.radius_px;

  for (std::size_t r = 0; r < ref.features.size(); ++r) {
    const Eigen::Vector3d image = H_cur_from_ref * ref_px[r].homogeneous();
    const Eigen::Vector2d predicted_px = image.hnormalized();
    const double predicted_sigma =
        static_cast<double>(ref.features[r].sigma_px) * local_scale(H_cur_from_ref, ref_px[r]);
    float nearest2 = std::numeric_limits<float>::infinity(), second2 = nearest2;
    std::size_t nearest = 0;
    auto row = std::lower_bound(row_px_.begin(), row_px_.end(), predicted_px.y() - settings_.radius_px);
    for (; row != row_px_.end() && *row <= predicted_px.y() + settings_.radius_px; ++row) {
      const auto c = static_cast<std::size_t>(by_row_[static_cast<std::size_t>(row - row_px_.begin())]);
      const Feature& feature = cur.features[c];
      if (feature.laplacian != ref.features[r].laplacian) continue;
      if (!((cur_px[c] - predicted_px).squaredNorm() < radius2_px2)) continue;
      if (std::abs(std::log(static_cast<double>(feature.sigma_px) / predicted_sigma)) > log_scale_ratio)
        continue;
      const float distance2 = squared_distance(ref.descriptors[r], cur.descriptors[c]);
      if (distance2 < nearest2) {
        second2 = nearest2;
        nearest2 = distance2;
        nearest = c;
      } else {
        second2 = std::min(second2, distance2);
      }
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
