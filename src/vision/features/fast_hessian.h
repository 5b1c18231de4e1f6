// The fast-Hessian detector (H. Bay et al., CVIU 2008, 3.2–3.4): maxima of the determinant of box-filter
// Hessians over position and scale, refined by a quadratic fit.
//
// Octave o samples every 2^o-th pixel with filters of side 3 (2^(o+1) (i+1) + 1), i = 0…3. Rows are streamed:
// a response lives in a ring of three rows from the moment it is made until its neighbours are known. A layer
// in which no maxima are looked for is only a neighbour of others: its responses are computed round their
// maxima alone, or by the row where these stand too close for that to pay.
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

class FastHessian {
 public:
  explicit FastHessian(int max_width_px);

  /// Adds the keypoints whose centre lies in `region` (inside the image) and whose sigma lies in the
  /// settings' range; layers out of that range are not computed.
  void detect(const IntegralImage& integral, const Region& region, const FeatureSettings& settings,
              KeypointSelection& selection);

 private:
  struct Octave;
  static Octave plan_octave(const IntegralImage& integral, const Region& region,
                            const FeatureSettings& settings, int index);
  void detect_octave(const IntegralImage& integral, const Octave& octave, KeypointSelection& selection);
  void find_in_row(const IntegralImage& integral, const Octave& octave, int layer, int row,
                   KeypointSelection& selection);
  void refine(const IntegralImage& integral, const Octave& octave, int layer, int row, int column,
              KeypointSelection& selection);
  void make_rows(const IntegralImage& integral, const Octave& octave, int layer, int first, int last);
  bool has_rows_round(int layer, int row) const;
  LayerRows rows_round(int layer, int row);
  float* ring_row(int layer, int row);

  std::size_t ring_stride_;
  std::vector<float> ring_;                                        ///< [layer][row mod 3][sample]
  std::array<std::array<int, 3>, kLayersPerOctave> ring_holds_{};  ///< which row; −1: none
  std::vector<std::int32_t> found_;
  HessianRowWork work_;
};

}  // namespace heel
