// Nearest neighbours among the features near a predicted place and of the predicted size. There a feature
// need be distinct only from its neighbours, not from the whole frame. This brings back pairs that the ratio
// test over the whole frame has to reject, mainly at the template's edges, where pairs constrain the pose
// most.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "heel/features.h"
#include "heel/matching.h"
#include "vision/matching/feature_grid.h"

namespace heel {

struct GuidedMatchSettings {
  double radius_px = 8.0;     ///< round the predicted place, undistorted pixels of the frame
  double scale_ratio = 1.5;   ///< largest ratio of a feature's scale to the predicted one, or its inverse
  float max_distance = 0.6f;  ///< between unit descriptors
  float ratio = 0.9f;         ///< nearest / second nearest within the radius
};

/// Where a template feature should be in the frame, and how much larger than in the template.
struct PredictedFeature {
  Eigen::Vector2d px;  ///< undistorted
  double scale = 0.0;  ///< 0: not visible
};

/// Each frame feature is paired with at most one template feature, the nearest.
class GuidedMatcher {
 public:
  /// Takes memory for `max_cur` frame features once.
  GuidedMatcher(int max_cur, const GuidedMatchSettings& settings);

  /// `predicted`: one for each feature of `ref`, in their order. Allocates nothing when `out` has capacity
  /// for a match for each feature of `ref`. `radius_px` replaces that of the settings.
  void match(const FeatureSet& ref, std::span<const PredictedFeature> predicted, const FeatureGrid& cur,
             double radius_px, std::vector<Match>& out);
  void match(const FeatureSet& ref, std::span<const PredictedFeature> predicted, const FeatureGrid& cur,
             std::vector<Match>& out);

 private:
  GuidedMatchSettings settings_;
  std::vector<std::int32_t> taken_by_;  // for each frame feature, index into `out` or −1
};

}  // namespace heel
