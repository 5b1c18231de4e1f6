// The loops of the fast-Hessian detector in SIMD: a row of responses, the maxima of a row, and the responses
// round one sample. Results are the same to the bit on every instruction set.
//
// Convention: sample i of a row lies at pixel step · i.
// Units: pixels; responses of grey levels 0…1.
// Source: H. Bay et al., "Speeded-Up Robust Features (SURF)", CVIU 2008, 3.2.
#pragma once

#include <hwy/aligned_allocator.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vision/features/integral_image.h"

namespace heel {

/// A box filter that approximates Gaussian second derivatives (Fig. 2): its side is 3 · lobe; sigma is 1.2 at
/// side 9.
struct BoxFilter {
  int lobe = 3;

  static constexpr float kSigmaPerSide = 1.2f / 9.f;
  constexpr int side() const { return 3 * lobe; }
  constexpr int half() const { return (3 * lobe - 1) / 2; }  ///< pixels to each side of its centre
};

/// Differences of rows of the integral image, which all boxes of one filter along a row share.
class HessianRowWork {
 public:
  explicit HessianRowWork(int max_width_px);
  std::uint32_t* xx() { return columns_.get(); }
  std::uint32_t* yy() { return columns_.get() + size_; }
  std::uint32_t* xy() { return columns_.get() + 2 * size_; }

 private:
  std::size_t size_;
  hwy::AlignedFreeUniquePtr<std::uint32_t[]> columns_;
};

/// A response row may be written this many samples past its last.
inline constexpr int kResponsePadding = 32;

/// response[i] = det(H) at (step · i, y) for i in [first, last): Dxx Dyy − (0.9 Dxy)², each normalised by the
/// area of the filter (Eq. (3)). The filter must lie inside the image at every sample. Writes up to
/// kResponsePadding values beyond `last`.
void hessian_response_row(const IntegralImage& integral, BoxFilter filter, int y, int step, int first,
                          int last, HessianRowWork& work, float* response);

/// Responses of one layer at 3 × 3 neighbouring samples: [row][column].
using ResponsePatch = std::array<std::array<float, 3>, 3>;

/// The same responses, to the bit, at the nine samples round pixel (x, y), `step` apart. The filter must lie
/// inside the image at all of them. False if one response exceeds `limit`; the patch is undefined then.
bool hessian_response_patch(const IntegralImage& integral, BoxFilter filter, int x, int y, int step,
                            float limit, ResponsePatch& patch);

/// Three neighbouring sample rows of one layer.
using LayerRows = std::array<const float*, 3>;

/// Writes each i in [first, last) whose response in the middle row of `own` exceeds `threshold` and is not
/// less than any of its neighbours: eight in its own layer, nine in each of `others`. Returns how many.
/// `maxima` has room for last − first + kResponsePadding.
int find_maxima_row(const LayerRows& own, std::span<const LayerRows> others, int first, int last,
                    float threshold, std::int32_t* maxima);

/// The sign of the trace Dxx + Dyy at pixel (x, y): +1 for a dark blob on a light ground.
std::int8_t laplacian_sign(const IntegralImage& integral, BoxFilter filter, int x, int y);

}  // namespace heel
