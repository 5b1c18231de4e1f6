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

/// Where a template feature should be in the frame, undistorted, and how many times larger.
struct PredictedView {
  Eigen::Vector2d px;
  double scale = 0.0;  ///< 0: not to be seen
};

/// Pairs template features with frame features near where they should be. Each frame feature is given to at
/// most one template feature, the nearest.
class GuidedMatcher {
 public:
  GuidedMatcher(int max_cur, const GuidedMatchSettings& settings);

  /// The frame's features for the matches to come, and their undistorted positions, in the same order; both
  /// are to outlive these.
  void look_at(const FeatureSet& cur, std::span<const Eigen::Vector2d> cur_px);

  /// `predicted`: one for each template feature, in their order. Allocates nothing when `out` has capacity
  /// for a match for each template feature.
  void match(std::span<const PredictedView> predicted, const FeatureSet& ref, std::vector<Match>& out);

 private:
  /// What is asked first of a frame feature.
  struct Candidate {
    double x_px, y_px;
    double sigma_px;
    std::int32_t index;
    std::int8_t laplacian;
  };
  /// A rectangle of cells, both ends included.
  struct Cells {
    int left, top, right, bottom;
  };
  int column_of(double x_px) const;
  int row_of(double y_px) const;
  Cells cells_near(const Eigen::Vector2d& px) const;

  GuidedMatchSettings settings_;
  const FeatureSet* cur_ = nullptr;
  // The frame's features by cells as wide as the radius (wider where few features spread far), row by row:
  // cell i has those from begin_[i] to begin_[i + 1].
  std::vector<Candidate> candidates_;
  std::vector<std::int32_t> begin_;
  Eigen::Vector2d origin_px_ = Eigen::Vector2d::Zero();
  double cell_px_ = 1.0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::int32_t> taken_by_;  // for each frame feature, index into `out` or −1
};

}  // namespace heel
