// The integral image (H. Bay et al., CVIU 2008, Eq. (1)): row(y)[x] is the sum of all pixels above y and left
// of x, so that pixel (x, y) covers [x, x+1) × [y, y+1) and a box is four reads.
// Sums are modulo 2³²; the difference of four is right as long as the box itself sums to less than that.
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstddef>
#include <cstdint>

#include "heel/flow.h"

namespace heel {

class IntegralImage {
 public:
  /// Columns after the last one that may be read (never used), so that loops can run in whole vectors.
  static constexpr int kReadablePadding = 64;

  IntegralImage(int max_width_px, int max_height_px);

  /// Needs a frame no larger than the constructor was told.
  void compute(const FrameView& frame);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  std::size_t stride() const { return stride_; }
  /// y in [0, height]; columns [0, width].
  const std::uint32_t* row(int y) const { return sums_.get() + static_cast<std::size_t>(y) * stride_; }

 private:
  std::size_t stride_;
  int width_px_ = 0;
  int height_px_ = 0;
  hwy::AlignedFreeUniquePtr<std::uint32_t[]> sums_;
};

}  // namespace heel
