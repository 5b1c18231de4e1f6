// Which keypoints are kept: a bounded list while detecting, then at most N, spread over the image or simply
// the strongest.
#pragma once

#include <cstddef>
#include <vector>

#include "heel/features.h"

namespace heel {

/// Stronger first; position and scale break ties, so that the order never depends on how features were found.
bool stronger(const Feature& a, const Feature& b);

/// Takes any number of keypoints and keeps the strongest `capacity` of them, at a cost bounded per keypoint:
/// when twice that many have come in, the weaker half goes and the threshold rises to the weakest kept.
class KeypointSelection {
 public:
  explicit KeypointSelection(std::size_t capacity);

  void start(float threshold);
  /// Keypoints that do not exceed this need not be added.
  float threshold() const { return threshold_; }
  void add(const Feature& keypoint);

  /// At most `count` of those added, strongest first. Spread: the region is cut into a grid of cells that
  /// take turns, each giving its strongest keypoint left, until `count` are chosen.
  void strongest(std::size_t count, std::vector<Feature>& out);
  void strongest_spread(std::size_t count, const Region& region, std::vector<Feature>& out);

 private:
  void drop_weaker_half();

  std::size_t capacity_;
  float threshold_ = 0.f;
  std::vector<Feature> keypoints_;
  std::vector<Feature> rest_;
};

}  // namespace heel
