// Which keypoints are kept: a list of bounded length during detection, then at most N of it, either spread
// over the image or the strongest.
//
// Units: pixels; a keypoint is stronger if its response is larger.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "heel/features.h"

namespace heel {

/// The order of keypoints. Position and scale break ties, so that it does not depend on the order of
/// detection.
bool stronger(const Feature& a, const Feature& b);

/// Keeps at least the strongest `capacity` of any number of keypoints. When twice as many are stored, the
/// weaker half is dropped and the threshold rises to the weakest that is kept; the mean cost of a keypoint is
/// constant.
class KeypointSelection {
 public:
  explicit KeypointSelection(std::size_t capacity);

  /// Forgets all keypoints.
  void start(float threshold);
  /// Keypoints whose response does not exceed this need not be added.
  float threshold() const { return threshold_; }
  void add(const Feature& keypoint);

  /// At most `count` of those added, strongest first. Spread: the region is divided into a grid of cells;
  /// each cell contributes its strongest keypoints up to an equal share of `count`, and the strongest of the
  /// rest fill it up.
  void strongest(std::size_t count, std::vector<Feature>& out);
  void strongest_spread(std::size_t count, const Region& region, std::vector<Feature>& out);

 private:
  /// A keypoint by its place among those kept.
  struct Ranked {
    float response;
    std::uint32_t place;
  };

  void drop_weaker_half();
  void rank_all();

  std::size_t capacity_;
  float threshold_ = 0.f;
  std::vector<Feature> keypoints_;
  std::vector<Ranked> ranking_;  // strongest first
};

}  // namespace heel
