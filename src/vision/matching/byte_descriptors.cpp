#include "vision/matching/byte_descriptors.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/matching/byte_descriptors.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HEEL_VISION_BYTE_DESCRIPTORS_ROUNDED
#define HEEL_VISION_BYTE_DESCRIPTORS_ROUNDED
namespace heel {

struct Rounded {
  std::array<std::uint8_t, kDescriptorSize> steps{};  // modulo 256
  int sum = 0;                                        // of the steps
  float error = 0.f;                                  // |a − centre − steps / scale|
  float excess = 0.f;                                 // (|steps / scale|² − |a|²) / 2
};

}  // namespace heel
#endif

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F32 = hn::CappedTag<float, 16>;
using U32 = hn::RebindToUnsigned<F32>;
using U8 = hn::Rebind<std::uint8_t, F32>;

// Added to a small number, it rounds it to a whole number, whose low byte is then the low byte of the float.
constexpr float kNoFraction = 12582912.f;  // 1.5 · 2²³

void RoundToSteps(const Descriptor& descriptor, const DescriptorCentre& centre, float scale, Rounded& out) {
  const F32 d;
  const auto limit = hn::Set(d, (RefBytes::kOffset - 1) / kRefSteps), least = hn::Neg(limit);
  const auto to_steps = hn::Set(d, scale), step = hn::Set(d, 1.f / scale),
             no_fraction = hn::Set(d, kNoFraction);
  auto sum = hn::Zero(d), error2 = sum, excess2 = sum;
  for (std::size_t k = 0; k < kDescriptorSize; k += hn::Lanes(d)) {
    const auto a = hn::LoadU(d, descriptor.data() + k);
    const auto moved = hn::Sub(a, hn::LoadU(d, centre.data() + k));
    const auto within = hn::Max(hn::Min(moved, limit), least);
    const auto steps = hn::Add(hn::Mul(within, to_steps), no_fraction);
    const auto whole = hn::Sub(steps, no_fraction);
    const auto rounded = hn::Mul(whole, step);
    const auto error = hn::Sub(moved, rounded);
    sum = hn::Add(sum, whole);
    error2 = hn::MulAdd(error, error, error2);
    excess2 = hn::MulAdd(rounded, rounded, hn::NegMulAdd(a, a, excess2));
    const auto byte = hn::And(hn::BitCast(U32(), steps), hn::Set(U32(), 0xFF));
    hn::StoreU(hn::U8FromU32(byte), U8(), out.steps.data() + k);
  }
  out.sum = static_cast<int>(hn::GetLane(hn::SumOfLanes(d, sum)));
  out.error = std::sqrt(hn::GetLane(hn::SumOfLanes(d, error2)));
  out.excess = 0.5f * hn::GetLane(hn::SumOfLanes(d, excess2));
}

// The bytes of eight members, stored as [pair of elements][member]: transpositions of 8 × 8 pairs.
void PackMembers(const Rounded* members, std::int8_t* out) {
  const hn::FixedTag<std::uint16_t, 8> d;
  const hn::Repartition<std::uint32_t, decltype(d)> d2;
  const hn::Repartition<std::uint64_t, decltype(d)> d4;
  using V = hn::Vec<decltype(d)>;
  for (std::size_t pair = 0; pair < CurBytes::kPairs; pair += 8) {
    const auto load = [&](std::size_t m) {
      return hn::BitCast(d, hn::LoadU(hn::FixedTag<std::uint8_t, 16>(), members[m].steps.data() + 2 * pair));
    };
    const auto store = [&](std::size_t p, V low, V high) {
      std::int8_t* row = out + (pair + p) * CurBytes::kBlock * 2;
      const auto of = [&](V first, V second, auto interleave) {
        return hn::BitCast(d, interleave(hn::BitCast(d4, first), hn::BitCast(d4, second)));
      };
      const hn::FixedTag<std::int8_t, 16> bytes;
      hn::StoreU(
          hn::BitCast(bytes, of(low, high, [&](auto x, auto y) { return hn::InterleaveLower(d4, x, y); })),
          bytes, row);
      hn::StoreU(
          hn::BitCast(bytes, of(low, high, [&](auto x, auto y) { return hn::InterleaveUpper(d4, x, y); })),
          bytes, row + CurBytes::kBlock * 2);
    };
    const auto lower2 = [&](V x, V y) {
      return hn::BitCast(d, hn::InterleaveLower(d2, hn::BitCast(d2, x), hn::BitCast(d2, y)));
    };
    const auto upper2 = [&](V x, V y) {
      return hn::BitCast(d, hn::InterleaveUpper(d2, hn::BitCast(d2, x), hn::BitCast(d2, y)));
    };
    V low[4], high[4];  // of members 2i and 2i + 1: pairs 0…3 and 4…7
    for (std::size_t i = 0; i < 4; ++i) {
      const V x = load(2 * i), y = load(2 * i + 1);
      low[i] = hn::InterleaveLower(d, x, y);
      high[i] = hn::InterleaveUpper(d, x, y);
    }
    store(0, lower2(low[0], low[1]), lower2(low[2], low[3]));
    store(2, upper2(low[0], low[1]), upper2(low[2], low[3]));
    store(4, lower2(high[0], high[1]), lower2(high[2], high[3]));
    store(6, upper2(high[0], high[1]), upper2(high[2], high[3]));
  }
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

HWY_EXPORT(RoundToSteps);
HWY_EXPORT(PackMembers);

namespace {

Rounded round_to_steps(const Descriptor& descriptor, const DescriptorCentre& centre, float scale) {
  Rounded rounded;
  HWY_DYNAMIC_DISPATCH(RoundToSteps)(descriptor, centre, scale, rounded);
  return rounded;
}

int in_product_units(float value) {
  return static_cast<int>(std::lround(value * kProductUnit));
}

/// The mean of a sample of about 64. Any centre is correct; this one makes elements small.
DescriptorCentre mean_of(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index) {
  constexpr std::size_t kSampleSize = 64;
  const std::size_t stride = index.size() / kSampleSize + 1;
  DescriptorCentre mean{};
  float count = 0.f;
  for (std::size_t i = 0; i < index.size(); i += stride, count += 1.f) {
    const Descriptor& descriptor = descriptors[static_cast<std::size_t>(index[i])];
    for (std::size_t k = 0; k < kDescriptorSize; ++k) mean[k] += descriptor[k];
  }
  for (float& element : mean) element /= std::max(1.f, count);
  return mean;
}

}  // namespace

RefBytes::RefBytes(std::size_t max_count)
    : data_(hwy::AllocateAligned<std::uint8_t>(std::max<std::size_t>(1, max_count) * kDescriptorSize)) {
  errors_.reserve(max_count);
  excess_.reserve(max_count);
}

void RefBytes::pack(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index,
                    const DescriptorCentre& centre) {
  errors_.clear();
  excess_.clear();
  max_error_ = 0.f;
  for (std::size_t i = 0; i < index.size(); ++i) {
    const Rounded rounded =
        round_to_steps(descriptors[static_cast<std::size_t>(index[i])], centre, kRefSteps);
    errors_.push_back(rounded.error);
    excess_.push_back(static_cast<std::int16_t>(in_product_units(rounded.excess)));
    max_error_ = std::max(max_error_, rounded.error);
    std::uint8_t* row = data_.get() + i * kDescriptorSize;
    for (std::size_t k = 0; k < kDescriptorSize; ++k)
      row[k] = static_cast<std::uint8_t>(rounded.steps[k] + kOffset);
  }
}

CurBytes::CurBytes(std::size_t max_count)
    : data_(hwy::AllocateAligned<std::int8_t>(padded(std::max<std::size_t>(1, max_count)) * kDescriptorSize)),
      offsets_(hwy::AllocateAligned<std::int16_t>(padded(std::max<std::size_t>(1, max_count)))) {
  errors_.reserve(max_count);
}

void CurBytes::pack(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index) {
  count_ = index.size();
  centre_ = mean_of(descriptors, index);
  errors_.clear();
  max_error_ = 0.f;
  constexpr std::size_t kAtOnce = 8;
  static_assert(kBlock % kAtOnce == 0);
  for (std::size_t first = 0; first < padded(count_); first += kAtOnce) {
    std::array<Rounded, kAtOnce> members{};
    for (std::size_t m = 0; m < kAtOnce && first + m < count_; ++m) {
      const Descriptor& descriptor = descriptors[static_cast<std::size_t>(index[first + m])];
      members[m] = round_to_steps(descriptor, centre_, kCurSteps);
      errors_.push_back(members[m].error);
      max_error_ = std::max(max_error_, members[m].error);
      offsets_[first + m] =
          static_cast<std::int16_t>(RefBytes::kOffset * members[m].sum + in_product_units(members[m].excess));
    }
    std::int8_t* block = data_.get() + first / kBlock * kBlock * kDescriptorSize;
    HWY_DYNAMIC_DISPATCH(PackMembers)(members.data(), block + first % kBlock * 2);
  }
}

}  // namespace heel
#endif  // HWY_ONCE
