// A picture at its size, half and a quarter of it, in floats, and squares of samples of it.
//
// Convention: integer coordinates are pixel centres, as they lie in the picture (distorted). Units: pixels,
// grey levels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace heel {

/// The side of the largest square of samples, its border of one sample included.
inline constexpr int kMaxPatchSide = 23;
/// A square of samples, row by row without padding; whole vectors may be read beyond its end.
using PatchSamples = std::array<float, kMaxPatchSide * kMaxPatchSide + 15>;

class GreyPyramid {
 public:
  /// `grey`: row-major, width_px × height_px.
  GreyPyramid(std::span<const std::uint8_t> grey, int width_px, int height_px);

  /// Samples `side` × `side` places of the picture round `centre_px`: a step to the right and a step down are
  /// the columns of `step_px`. Long steps read a smaller picture, so that no detail is skipped. False: a
  /// sample would lie outside.
  bool sample(const Eigen::Vector2d& centre_px, const Eigen::Matrix2d& step_px, int side,
              PatchSamples& out) const;

  /// Bilinear, of the picture at its size / 2^level; `px` are pixels of the full picture. Places outside have
  /// the value of the nearest edge.
  float at(const Eigen::Vector2d& px, std::size_t level = 0) const;

  static constexpr std::size_t kLevels = 3;

 private:
  struct Level {
    int width_px = 0, height_px = 0;
    std::vector<float> grey;
    float at(const Eigen::Vector2d& px) const;
    Level half() const;
  };
  std::vector<Level> levels_;
};

}  // namespace heel
