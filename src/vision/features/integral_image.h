// The integral image, from which a box sum takes four reads.
//
// Convention: row(y)[x] is the sum of all pixels above y and left of x; pixel (x, y) covers [x, x+1) × [y,
// y+1).
// Units: sums of grey levels 0…255, modulo 2³². The difference of four sums is exact if the box's own sum is
// smaller than 2³².
// Source: H. Bay et al., "Speeded-Up Robust Features (SURF)", CVIU 2008, Eq. (1).
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstddef>
#include <cstdint>

#include "heel/features.h"
#include "heel/flow.h"

namespace heel {

class IntegralImage {
 public:
  /// Columns after the last that may be read, so that loops can run in whole vectors. Their values are not
  /// used.
  static constexpr int kReadablePadding = 64;

  IntegralImage(int max_width_px, int max_height_px);

  /// `frame` must not be larger than the constructor's sizes.
  void compute(const FrameView& frame);
  /// Only of `part`, which lies inside the frame: the sums begin at its first row and column, so the
  /// difference of four of them is the same. Rows and columns outside are undefined.
  void compute(const FrameView& frame, const Region& part);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  std::size_t stride() const { return stride_; }
  /// y in [0, height]; it has columns [0, width].
  const std::uint32_t* row(int y) const { return sums_.get() + static_cast<std::size_t>(y) * stride_; }

 private:
  std::size_t stride_;
  int width_px_ = 0;
  int height_px_ = 0;
  hwy::AlignedFreeUniquePtr<std::uint32_t[]> sums_;
};

}  // namespace heel
