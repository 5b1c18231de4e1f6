#include "guided_matcher.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace heel {
namespace {

float squared_distance(const Descriptor& a, const Descriptor& b) {
  const Eigen::Map<const Eigen::Matrix<float, kDescriptorSize, 1>> u(a.data()), v(b.data());
  return (u - v).squaredNorm();
}

}  // namespace

GuidedMatcher::GuidedMatcher(int max_cur, const GuidedMatchSettings& settings) : settings_(settings) {
  candidates_.reserve(static_cast<std::size_t>(max_cur));
  taken_by_.reserve(static_cast<std::size_t>(max_cur));
}

void GuidedMatcher::look_at(const FeatureSet& cur, std::span<const Eigen::Vector2d> cur_px) {
  cur_ = &cur;
  candidates_.clear();
  for (std::size_t i = 0; i < cur_px.size(); ++i)
    candidates_.push_back({cur_px[i].y(), cur_px[i].x(), static_cast<double>(cur.features[i].sigma_px),
                           static_cast<std::int32_t>(i), cur.features[i].laplacian});
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.y_px, a.index) < std::tie(b.y_px, b.index);
  });
}

void GuidedMatcher::match(std::span<const PredictedView> predicted, const FeatureSet& ref,
                          std::vector<Match>& out) {
  taken_by_.assign(candidates_.size(), -1);
  out.clear();
  const double radius2_px2 = settings_.radius_px * settings_.radius_px;

  for (std::size_t r = 0; r < ref.features.size(); ++r) {
    const Eigen::Vector2d& predicted_px = predicted[r].px;
    const double predicted_sigma = static_cast<double>(ref.features[r].sigma_px) * predicted[r].scale;
    const double smallest_sigma = predicted_sigma / settings_.scale_ratio;
    const double largest_sigma = predicted_sigma * settings_.scale_ratio;
    float nearest2 = std::numeric_limits<float>::infinity(), second2 = nearest2;
    std::size_t nearest = 0;
    auto candidate =
        std::lower_bound(candidates_.begin(), candidates_.end(), predicted_px.y() - settings_.radius_px,
                         [](const Candidate& c, double y_px) { return c.y_px < y_px; });
    for (; candidate != candidates_.end() && candidate->y_px <= predicted_px.y() + settings_.radius_px;
         ++candidate) {
      if (candidate->laplacian != ref.features[r].laplacian) continue;
      const double dx_px = candidate->x_px - predicted_px.x(), dy_px = candidate->y_px - predicted_px.y();
      if (!(dx_px * dx_px + dy_px * dy_px < radius2_px2)) continue;
      if (candidate->sigma_px < smallest_sigma || candidate->sigma_px > largest_sigma) continue;
      const auto c = static_cast<std::size_t>(candidate->index);
      const float distance2 = squared_distance(ref.descriptors[r], cur_->descriptors[c]);
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
