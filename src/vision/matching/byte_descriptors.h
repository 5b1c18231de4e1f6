// Descriptors rounded to bytes, each with its rounding error, for a first, coarse comparison.
//
// Convention: ref (template), cur (frame). Units: elements of unit descriptors; products in 1 / kProductUnit.
#pragma once

#include <hwy/aligned_allocator.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "heel/features.h"

namespace heel {

/// Steps that represent 1 in a ref and in a cur. Their product represents an inner product of 1. Rounding
/// increases the distance of two opposite descriptors to at most 2 + 4 / 150 + 4 / 195, so the smallest
/// product is −1.10 times kProductUnit, which fits 16 bits.
inline constexpr float kRefSteps = 150.f;
inline constexpr float kCurSteps = 195.f;
inline constexpr float kProductUnit = kRefSteps * kCurSteps;

/// A centre common to refs and curs is subtracted before rounding. It does not change distances and makes
/// elements small. Elements beyond ±0.42 are clipped, which increases no distance.
using DescriptorCentre = std::array<float, kDescriptorSize>;

/// The refs: element k is round(150 (a − centre)_k) + 64. Unsigned and at most 127, so that the sum of two
/// products with signed bytes fits 16 bits.
class RefBytes {
 public:
  static constexpr int kOffset = 64;

  explicit RefBytes(std::size_t max_count);
  /// Takes descriptors[index[i]] for all i.
  void pack(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index,
            const DescriptorCentre& centre);

  std::size_t count() const { return errors_.size(); }
  const std::uint8_t* row(std::size_t i) const { return data_.get() + i * kDescriptorSize; }
  std::int16_t excess(std::size_t i) const { return excess_[i]; }  ///< (|a'|² − |a|²) / 2, in product units
  float error(std::size_t i) const { return errors_[i]; }          ///< |a' − a|, of rounding and clipping
  float max_error() const { return max_error_; }

 private:
  hwy::AlignedFreeUniquePtr<std::uint8_t[]> data_;
  std::vector<std::int16_t> excess_;
  std::vector<float> errors_;
  float max_error_ = 0.f;
};

/// The curs: element k is round(195 (b − centre)_k). They are stored for the comparison of many at a time, in
/// blocks of kBlock members as [k / 2][member][k % 2].
class CurBytes {
 public:
  static constexpr std::size_t kBlock = 64;
  static constexpr std::size_t kPairs = kDescriptorSize / 2;

  explicit CurBytes(std::size_t max_count);
  /// Takes descriptors[index[i]] for all i, and the mean of a sample of them as the centre. Missing members
  /// of the last block are zero.
  void pack(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index);

  std::size_t count() const { return count_; }
  std::size_t blocks() const { return (count_ + kBlock - 1) / kBlock; }
  const std::int8_t* block(std::size_t b) const { return data_.get() + b * kBlock * kDescriptorSize; }
  const DescriptorCentre& centre() const { return centre_; }
  /// For each member, in product units modulo 2¹⁶: what RefBytes::kOffset adds to its products, plus (|b'|² −
  /// |b|²) / 2.
  const std::int16_t* offsets() const { return offsets_.get(); }
  float error(std::size_t i) const { return errors_[i]; }  ///< |b' − b|, of rounding and clipping
  float max_error() const { return max_error_; }

  static constexpr std::size_t padded(std::size_t count) { return (count + kBlock - 1) / kBlock * kBlock; }

 private:
  std::size_t count_ = 0;
  DescriptorCentre centre_{};
  hwy::AlignedFreeUniquePtr<std::int8_t[]> data_;
  hwy::AlignedFreeUniquePtr<std::int16_t[]> offsets_;
  std::vector<float> errors_;
  float max_error_ = 0.f;
};

}  // namespace heel
