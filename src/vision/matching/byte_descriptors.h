// Descriptors rounded to bytes, with how far each was moved by it: what a first, coarse comparison reads.
#pragma once

#include <hwy/aligned_allocator.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "heel/features.h"

namespace heel {

/// Steps to 1 of a ref and of a cur. Their product is what stands for an inner product of 1. With what
/// rounding adds to the distance of two opposite descriptors, at most 2 + 4 / 150 + 4 / 195, the least
/// product is −1.10 of it, which 16 bits hold.
inline constexpr float kRefSteps = 150.f;
inline constexpr float kCurSteps = 195.f;
inline constexpr float kProductUnit = kRefSteps * kCurSteps;

/// What is rounded is a descriptor seen from a centre common to refs and curs, which leaves distances as they
/// are and elements small. Elements beyond ±0.42 are cut, which brings no two descriptors further apart.
using DescriptorCentre = std::array<float, kDescriptorSize>;

/// Unsigned and at most 127, so that two products with signed bytes add up within 16 bits: element k is
/// round(150 (a − centre)_k) + 64.
class RefBytes {
 public:
  static constexpr int kOffset = 64;

  explicit RefBytes(std::size_t max_count);
  /// Takes descriptors[index[i]] for all i.
  void pack(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index,
            const DescriptorCentre& centre);

  std::size_t count() const { return errors_.size(); }
  const std::uint8_t* row(std::size_t i) const { return data_.get() + i * kDescriptorSize; }
  std::int16_t excess(std::size_t i) const { return excess_[i]; }  ///< (|a'|² − |a|²) / 2, of products' units
  float error(std::size_t i) const { return errors_[i]; }          ///< how far rounding and cutting moved it
  float max_error() const { return max_error_; }

 private:
  hwy::AlignedFreeUniquePtr<std::uint8_t[]> data_;
  std::vector<std::int16_t> excess_;
  std::vector<float> errors_;
  float max_error_ = 0.f;
};

/// Laid out for comparing many at a time: blocks of kBlock members, two elements after two elements,
/// [k / 2][member][k % 2]; element k is round(195 (b − centre)_k).
class CurBytes {
 public:
  static constexpr std::size_t kBlock = 64;
  static constexpr std::size_t kPairs = kDescriptorSize / 2;

  explicit CurBytes(std::size_t max_count);
  /// Takes descriptors[index[i]] for all i, and about their mean for the centre; absent members of the last
  /// block are zero.
  void pack(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index);

  std::size_t count() const { return count_; }
  std::size_t blocks() const { return (count_ + kBlock - 1) / kBlock; }
  const std::int8_t* block(std::size_t b) const { return data_.get() + b * kBlock * kDescriptorSize; }
  const DescriptorCentre& centre() const { return centre_; }
  /// Modulo 2¹⁶, of products' units: what RefBytes' offset adds to a product with a member, and (|b'|² −
  /// |b|²) / 2.
  const std::int16_t* offsets() const { return offsets_.get(); }
  float max_error() const { return max_error_; }

  static constexpr std::size_t padded(std::size_t count) { return (count + kBlock - 1) / kBlock * kBlock; }

 private:
  std::size_t count_ = 0;
  DescriptorCentre centre_{};
  hwy::AlignedFreeUniquePtr<std::int8_t[]> data_;
  hwy::AlignedFreeUniquePtr<std::int16_t[]> offsets_;
  float max_error_ = 0.f;
};

}  // namespace heel
