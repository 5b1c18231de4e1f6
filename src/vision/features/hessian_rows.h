// Rows of fast-Hessian responses and of their maxima, the two loops over all pixels, and the responses round
// a single sample, in SIMD. Results are the same to the bit whatever the instruction set.
#pragma once

#include <hwy/aligned_allocator.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vision/features/integral_image.h"

namespace heel {

/// A box filter approximating Gaussian second derivatives (CVIU 2008, Fig. 2): side 3·lobe, sigma 1.2 at 9.
struct BoxFilter {
  int lobe = 3;

  static constexpr float kSigmaPerSide = 1.2f / 9.f;
  int side() const { return 3 * lobe; }
  int half() const { return (3 * lobe - 1) / 2; }  ///< pixels it reaches beyond its centre
};

/// Differences of integral image rows: what the boxes of one filter have in common along a row.
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

/// Samples a response row may be written past its last.
inline constexpr int kResponsePadding = 32;

/// response[i] = det(H) at (step · i, y) for i in [first, last): Dxx Dyy − (0.9 Dxy)², each normalised by the
/// filter's area (Eq. (3)), grey levels 0…1. The filter must fit the image at every sample.
/// Writes up to kResponsePadding values beyond `last`.
void hessian_response_row(const IntegralImage& integral, BoxFilter filter, int y, int step, int first,
                          int last, HessianRowWork& work, float* response);

/// Responses of one layer at 3 × 3 neighbouring samples: [row][column].
using ResponsePatch = std::array<std::array<float, 3>, 3>;

/// The same responses, to the bit, at the nine samples round pixel (x, y), `step` apart. The filter must fit
/// the image at all of them. False, and the patch undefined, when one of them exceeds `not_above`.
bool hessian_response_patch(const IntegralImage& integral, BoxFilter filter, int x, int y, int step,
                            float not_above, ResponsePatch& patch);

/// Three neighbouring sample rows of one layer.
using LayerRows = std::array<const float*, 3>;

/// Writes the i in [first, last) whose response in the middle of `own` exceeds `threshold` and is not less
/// than any of its neighbours, eight in its own layer and nine in each of `others`; returns how many. `found`
/// has room for last − first + kResponsePadding.
int find_maxima_row(const LayerRows& own, std::span<const LayerRows> others, int first, int last,
                    float threshold, std::int32_t* found);

/// Sign of the trace Dxx + Dyy at pixel (x, y): +1 for a dark blob on light.
std::int8_t laplacian_sign(const IntegralImage& integral, BoxFilter filter, int x, int y);

}  // namespace heel
