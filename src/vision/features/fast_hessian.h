// The fast-Hessian detector: maxima of the determinant of box-filter Hessians over position and scale,
// refined by a quadratic fit.
//
// Convention: octave o has a sample at every 2^o-th pixel and filters of side 3 (2^(o+1) (i+1) + 1) for layer
// i = 0…3.
// Units: pixels; responses of grey levels 0…1.
// Source: H. Bay et al., "Speeded-Up Robust Features (SURF)", CVIU 2008, 3.2–3.4.
//
// Responses are computed row by row, and a ring of three rows of each layer is kept. A layer in which no
// maxima are searched is only compared with its neighbours: its responses are computed only round the maxima
// of these, or as whole rows where the maxima are so dense that rows cost less.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "heel/features.h"
#include "vision/features/hessian_rows.h"
#include "vision/features/integral_image.h"
#include "vision/features/keypoint_selection.h"

namespace heel {

inline constexpr int kMaxOctaves = 4;
inline constexpr int kLayersPerOctave = 4;

constexpr BoxFilter octave_filter(int octave, int layer) {
  return BoxFilter{(2 << octave) * (layer + 1) + 1};
}

/// Of all keypoints: half-way between the last two layers.
constexpr float largest_sigma_px(int octaves) {
  const int sides = octave_filter(octaves - 1, kLayersPerOctave - 2).side() +
                    octave_filter(octaves - 1, kLayersPerOctave - 1).side();
  return 0.5f * BoxFilter::kSigmaPerSide * static_cast<float>(sides);
}

class FastHessian {
 public:
  explicit FastHessian(int max_width_px);

  /// How far beyond the region detection reads the image: a keypoint is found at a sample up to two steps
  /// away, and compared with that sample's neighbours.
  static constexpr int reach_px(int octaves) {
    return octave_filter(octaves - 1, kLayersPerOctave - 1).half() + 1 + 3 * (1 << (octaves - 1));
  }

  /// Adds the keypoints whose centre lies in `region` (inside the image) and whose sigma lies in the
  /// settings' range; layers out of that range are not computed.
  void detect(const IntegralImage& integral, const Region& region, const FeatureSettings& settings,
              KeypointSelection& selection);

 private:
  struct Octave;
  static Octave plan_octave(const IntegralImage& integral, const Region& region,
                            const FeatureSettings& settings, int index);
  void detect_octave(const IntegralImage& integral, const Octave& octave, KeypointSelection& selection);
  void find_maxima_in_row(const IntegralImage& integral, const Octave& octave, int layer, int row,
                          KeypointSelection& selection);
  void refine(const IntegralImage& integral, const Octave& octave, int layer, int row, int column,
              KeypointSelection& selection);
  void compute_rows(const IntegralImage& integral, const Octave& octave, int layer, int first, int last);
  bool has_rows_around(int layer, int row) const;
  LayerRows rows_around(int layer, int row);
  float* ring_row(int layer, int row);

  std::size_t ring_stride_;
  std::vector<float> ring_;                                        ///< [layer][row mod 3][sample]
  std::array<std::array<int, 3>, kLayersPerOctave> ring_holds_{};  ///< the row in it; −1: none
  std::vector<std::int32_t> maxima_;
  HessianRowWork work_;
};

}  // namespace heel
