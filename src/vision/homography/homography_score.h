// The cost of a homography over all pairs: the inner loop of RANSAC, laid out for SIMD.
//
// Convention: x_cur ~ H_cur_from_ref x_ref. Units: pixels, squared errors in px².
// Source: MSAC: P. Torr and A. Zisserman, "MLESAC", CVIU 78(1), 2000.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace heel {

/// Point pairs as four columns of floats, padded with pairs that fit no homography. Coordinates must be
/// relative to the centroids: there floats are exact to 1e-4 px over a full-HD frame.
class ScoreTable {
 public:
  explicit ScoreTable(std::size_t max_pairs);

  void clear();
  void add(const Eigen::Vector2d& ref_px, const Eigen::Vector2d& cur_px);

  /// Σ min(e, limit), where e is the squared symmetric transfer error. A pair behind a camera (w ≤ 0) is an
  /// outlier, so H must have w > 0 on the visible plane. Stops as soon as the sum exceeds `stop_above`; the
  /// result exceeds it then. The order of the additions is fixed: the same result on every machine.
  float cost_px2(const Eigen::Matrix3d& H_cur_from_ref, float limit_px2, float stop_above) const;

 private:
  static constexpr std::size_t kLanes = 8;

  std::size_t size_ = 0;
  std::vector<float> ref_x_, ref_y_, cur_x_, cur_y_;
};

}  // namespace heel
