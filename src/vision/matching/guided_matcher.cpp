#include "vision/matching/guided_matcher.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace heel {
namespace {

float squared_distance(const Descriptor& a, const Descriptor& b) {
  const Eigen::Map<const Eigen::Matrix<float, kDescriptorSize, 1>> u(a.data()), v(b.data());
  return (u - v).squaredNorm();
}

}  // namespace

GuidedMatcher::GuidedMatcher(int max_cur, const GuidedMatchSettings& settings) : settings_(settings) {
  taken_by_.reserve(static_cast<std::size_t>(max_cur));
}

void GuidedMatcher::match(const FeatureSet& ref, std::span<const PredictedFeature> predicted,
                          const FeatureGrid& cur, std::vector<Match>& out) {
  match(ref, predicted, cur, settings_.radius_px, out);
}

void GuidedMatcher::match(const FeatureSet& ref, std::span<const PredictedFeature> predicted,
                          const FeatureGrid& cur, double radius_px, std::vector<Match>& out) {
  taken_by_.assign(cur.undistorted_px().size(), -1);
  out.clear();
  const double radius2_px2 = radius_px * radius_px;
  const FeatureSet& cur_features = cur.features();

  for (std::size_t r = 0; r < ref.features.size(); ++r) {
    const Eigen::Vector2d& predicted_px = predicted[r].px;
    if (!(predicted[r].scale > 0.0) || !predicted_px.allFinite()) continue;
    const double predicted_sigma_px = static_cast<double>(ref.features[r].sigma_px) * predicted[r].scale;
    const double min_sigma_px = predicted_sigma_px / settings_.scale_ratio;
    const double max_sigma_px = predicted_sigma_px * settings_.scale_ratio;
    float nearest2 = std::numeric_limits<float>::infinity(), second2 = nearest2;
    std::size_t nearest = 0;
    cur.visit_near(predicted_px, radius_px, [&](const FeatureGrid::Entry& entry) {
      if (entry.laplacian != ref.features[r].laplacian) return;
      const double dx_px = entry.x_px - predicted_px.x(), dy_px = entry.y_px - predicted_px.y();
      if (!(dx_px * dx_px + dy_px * dy_px < radius2_px2)) return;
      if (entry.sigma_px < min_sigma_px || entry.sigma_px > max_sigma_px) return;
      const auto c = static_cast<std::size_t>(entry.index);
      const float distance2 = squared_distance(ref.descriptors[r], cur_features.descriptors[c]);
      if (distance2 < nearest2) {
        second2 = nearest2;
        nearest2 = distance2;
        nearest = c;
      } else {
        second2 = std::min(second2, distance2);
      }
    });
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
