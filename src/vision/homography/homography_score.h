// Scores a homography against all pairs: the inner loop of RANSAC, laid out for the vector unit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace heel {

/// Point pairs as four columns of floats, in coordinates near their centroids (floats are exact enough there:
/// 1e-4 px over a full-HD frame). Padded with pairs that fit no homography.
class ScoreTable {
 public:
  explicit ScoreTable(std::size_t max_pairs);

  void clear();
  void add(const Eigen::Vector2d& ref_px, const Eigen::Vector2d& cur_px);

  /// MSAC (P. Torr and A. Zisserman, "MLESAC", CVIU 2000): Σ min(e, limit), e the squared symmetric transfer
  /// error. A pair behind either camera (w ≤ 0) counts as an outlier, so H must have w > 0 on the plane seen.
  /// Gives up as soon as the sum passes `stop_above`, which the result then exceeds too.
  /// The order of the additions is fixed: the same on every machine.
  float cost_px2(const Eigen::Matrix3d& H_cur_from_ref, float limit_px2, float stop_above) const;

 private:
  static constexpr std::size_t kLanes = 8;

  std::size_t size_ = 0;
  std::vector<float> ref_x_, ref_y_, cur_x_, cur_y_;
};

}  // namespace heel
