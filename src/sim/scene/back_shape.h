// The relief of one person's back under the shirt. The numbers of the average back, and how far people
// differ, were measured on bodies that are not part of heel; docs/experiments.md gives them.
#pragma once

#include <cstdint>

namespace heel::sim {

/// The part of the back that a template shows: half its width and height, and the height of its middle above
/// the hips.
inline constexpr double kBackHalfWidth_m = 0.157;
inline constexpr double kBackHalfHeight_m = 0.245;
inline constexpr double kBackMiddleZ_m = 0.265;

class BackShape {
 public:
  /// `depth`: from chest to back, relative to the average body; the sides of a deep body fall further.
  BackShape(double depth, std::uint64_t seed);

  /// How far the back lies before (away from a camera behind the person) the plane through its middle, at the
  /// relative place u (−1 … 1 from the person's left to the right) and v (−1 … 1 from the shoulders to the
  /// waist). Places up to a sixth outside keep the shape.
  double depth_m(double u, double v) const;

 private:
  struct Bump {
    double u, v, height_m, half_u, half_v;
  };
  double u1_, u2_, u4_, v1_, v2_, v3_, u2v_, uv_;
  Bump blades_[2]{};
  Bump spine_{};
};

}  // namespace heel::sim
