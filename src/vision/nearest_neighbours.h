// Exact nearest neighbours among unit descriptors, by the largest inner product: |a − b|² = 2 − 2 a·b.
#pragma once

#include <hwy/aligned_allocator.h>

#include <cstddef>
#include <cstdint>
#include <span>

#include "heel/features.h"

namespace heel {

/// Descriptors laid out for comparing many at a time: blocks of kBlock, element by element, [k][member].
class DescriptorBlocks {
 public:
  static constexpr int kBlock = 32;

  explicit DescriptorBlocks(int max_count);
  /// Packs descriptors[index[i]] for all i; absent members of the last block are zero.
  void pack(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index);

  int count() const { return count_; }
  int blocks() const { return (count_ + kBlock - 1) / kBlock; }
  const float* block(int b) const {
    return data_.get() + static_cast<std::size_t>(b) * kBlock * kDescriptorSize;
  }

 private:
  int count_ = 0;
  hwy::AlignedFreeUniquePtr<float[]> data_;
};

/// What a ref knows of the packed descriptors: its two largest inner products and with whom the larger.
struct Nearest {
  float best = -2.f;
  float second = -2.f;
  std::int32_t index = -1;
};

/// What each packed descriptor knows of the refs: its largest inner product, and with which ref.
struct NearestRefs {
  explicit NearestRefs(int max_count);
  hwy::AlignedFreeUniquePtr<float[]> best;
  hwy::AlignedFreeUniquePtr<std::int32_t[]> index;
};

/// Compares each of refs[ref_index[i]] with all packed descriptors. Indices count in ref_index and in the
/// packed order. Of equals the first wins.
void find_nearest(std::span<const Descriptor> refs, std::span<const std::int32_t> ref_index,
                  const DescriptorBlocks& packed, std::span<Nearest> of_ref, NearestRefs& of_packed);

}  // namespace heel
