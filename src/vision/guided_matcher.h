// Matching once more where a homography says to look: near the predicted place, at the predicted scale, a
// feature need no longer be told apart from the whole frame, only from its neighbours. That brings back the
// pairs that the ratio test had to throw away, above all at the template's edges, where they steady the fit
// most.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "heel/features.h"
#include "heel/matching.h"

namespace heel {

struct GuidedMatchSettings {
  double radius_px = 8.0;     ///< about the predicted place, undistorted pixels of the frame
  double scale_ratio = 1.5;   ///< of the feature's scale to the predicted one, either way
  float max_distance = 0.6f;  ///< between unit descriptors
  float ratio = 0.9f;         ///< nearest / second nearest within the radius
};

/// Pairs template features with frame features under H. `ref_px` and `cur_px` are the features' undistorted
/// positions, in their order. Each frame feature is given to at most one template feature, the nearest.
class GuidedMatcher {
 public:
  GuidedMatcher(int max_cur, const GuidedMatchSettings& settings);

  /// Allocates nothing when `out` has capacity for a match for each template feature.
  void match(const Eigen::Matrix3d& H_cur_from_ref, const FeatureSet& ref,
             std::span<const Eigen::Vector2d> ref_px, const FeatureSet& cur,
             std::span<const Eigen::Vector2d> cur_px, std::vector<Match>& out);

 private:
  void sort_by_row(std::span<const Eigen::Vector2d> cur_px);

  GuidedMatchSettings settings_;
  std::vector<std::int32_t> by_row_;    // frame features, top to bottom
  std::vector<double> row_px_;          // their y, in that order
  std::vector<std::int32_t> taken_by_;  // for each frame feature, index into `out` or −1
};

}  // namespace heel
