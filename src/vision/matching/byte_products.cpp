#include "vision/matching/byte_products.h"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/matching/byte_products.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
constexpr std::size_t kMaxBytes = 64;
using U8 = hn::CappedTag<std::uint8_t, kMaxBytes>;
using I8 = hn::RebindToSigned<U8>;
using I16 = hn::Repartition<std::int16_t, I8>;
using U16 = hn::RebindToUnsigned<I16>;

// a[2i] b[2i] + a[2i+1] b[2i+1] for bytes a ≤ 127, in 16 bits. Highway 1.0 has no function for it.
HWY_INLINE hn::Vec<I16> pair_products(hn::Vec<U8> a, hn::Vec<I8> b) {
#if HWY_TARGET == HWY_SSSE3 || HWY_TARGET == HWY_SSE4
  return hn::Vec<I16>{_mm_maddubs_epi16(a.raw, b.raw)};
#elif HWY_TARGET == HWY_AVX2
  return hn::Vec<I16>{_mm256_maddubs_epi16(a.raw, b.raw)};
#elif HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
  return hn::Vec<I16>{_mm512_maddubs_epi16(a.raw, b.raw)};
#elif HWY_TARGET == HWY_NEON && HWY_ARCH_ARM_A64
  const int8x16_t signed_a = vreinterpretq_s8_u8(a.raw);
  return hn::Vec<I16>{
      vpaddq_s16(vmull_s8(vget_low_s8(signed_a), vget_low_s8(b.raw)), vmull_high_s8(signed_a, b.raw))};
#else
  const I16 d;
  const auto a16 = hn::BitCast(d, a), b16 = hn::BitCast(d, b);
  const auto even = [](hn::Vec<I16> v) { return hn::ShiftRight<8>(hn::ShiftLeft<8>(v)); };
  const auto odd = [](hn::Vec<I16> v) { return hn::ShiftRight<8>(v); };
  return hn::Add(hn::Mul(even(a16), even(b16)), hn::Mul(odd(a16), odd(b16)));
#endif
}

// The elements of kByteTile refs in pairs, each pair repeated over a whole vector; and their excesses.
struct WideRefs {
  HWY_ALIGN std::uint8_t pairs[CurBytes::kPairs][kByteTile][kMaxBytes];
  std::int16_t excess[kByteTile];

  void load(const RefBytes& refs, std::size_t first) {
    const U16 d;
    for (std::size_t t = 0; t < kByteTile; ++t) {
      const std::size_t ref = std::min(first + t, refs.count() - 1);
      const std::uint8_t* row = refs.row(ref);
      for (std::size_t pair = 0; pair < CurBytes::kPairs; ++pair) {
        std::uint16_t both;
        std::memcpy(&both, row + 2 * pair, sizeof(both));
        hn::Store(hn::BitCast(U8(), hn::Set(d, both)), U8(), pairs[pair][t]);
      }
      excess[t] = refs.excess(ref);
    }
  }
};

// Multiplies two vectors of members with the tile. Eight independent sums hide the latency of each addition.
HWY_INLINE void multiply(const WideRefs& refs, const std::int8_t* members, const std::int16_t* offsets,
                         std::int16_t* products, std::size_t stride) {
  const U8 du;
  const I8 di;
  const I16 d;
  const std::size_t n = hn::Lanes(d);
  auto a0 = hn::Zero(d), a1 = a0, b0 = a0, b1 = a0, c0 = a0, c1 = a0, e0 = a0, e1 = a0;
  for (std::size_t pair = 0; pair < CurBytes::kPairs; ++pair, members += 2 * CurBytes::kBlock) {
    const auto x0 = hn::Load(di, members), x1 = hn::Load(di, members + 2 * n);
    const auto a = hn::Load(du, refs.pairs[pair][0]), b = hn::Load(du, refs.pairs[pair][1]);
    const auto c = hn::Load(du, refs.pairs[pair][2]), e = hn::Load(du, refs.pairs[pair][3]);
    a0 = hn::Add(a0, pair_products(a, x0));
    a1 = hn::Add(a1, pair_products(a, x1));
    b0 = hn::Add(b0, pair_products(b, x0));
    b1 = hn::Add(b1, pair_products(b, x1));
    c0 = hn::Add(c0, pair_products(c, x0));
    c1 = hn::Add(c1, pair_products(c, x1));
    e0 = hn::Add(e0, pair_products(e, x0));
    e1 = hn::Add(e1, pair_products(e, x1));
  }
  // Sums and offsets are modulo 2¹⁶; their difference is exact.
  const auto offset0 = hn::Load(d, offsets), offset1 = hn::Load(d, offsets + n);
  const auto store = [&](std::size_t t, hn::Vec<I16> low, hn::Vec<I16> high) {
    const auto excess = hn::Set(d, refs.excess[t]);
    hn::Store(hn::Sub(hn::Sub(low, offset0), excess), d, products + t * stride);
    hn::Store(hn::Sub(hn::Sub(high, offset1), excess), d, products + t * stride + n);
  };
  store(0, a0, a1);
  store(1, b0, b1);
  store(2, c0, c1);
  store(3, e0, e1);
}

void ByteProducts(const RefBytes& refs, std::size_t first, const CurBytes& curs, std::int16_t* products) {
  // Filled at once: clearing it would cost time. NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
  WideRefs wide;
  wide.load(refs, first);
  const std::size_t stride = curs.blocks() * CurBytes::kBlock, step = 2 * hn::Lanes(I16());
  for (std::size_t begin = 0; begin < stride; begin += step) {
    const std::int8_t* members = curs.block(begin / CurBytes::kBlock) + begin % CurBytes::kBlock * 2;
    multiply(wide, members, curs.offsets() + begin, products + begin, stride);
  }
  for (std::size_t t = 0; t < kByteTile; ++t)
    std::fill(products + t * stride + curs.count(), products + (t + 1) * stride, kAbsentProduct);
}

HWY_INLINE void keep(hn::Vec<I16> value, hn::Vec<I16>& first, hn::Vec<I16>& second) {
  second = hn::Max(second, hn::Min(first, value));
  first = hn::Max(first, value);
}

TwoLargest LargestTwo(std::span<const std::int16_t> row) {
  const I16 d;
  const std::size_t n = hn::Lanes(d);
  auto first = hn::Set(d, kAbsentProduct), second = first;
  for (std::size_t i = 0; i < row.size(); i += n) keep(hn::Load(d, row.data() + i), first, second);
  HWY_ALIGN std::int16_t firsts[kMaxBytes / 2], seconds[kMaxBytes / 2];
  hn::Store(first, d, firsts);
  hn::Store(second, d, seconds);
  TwoLargest largest;
  for (std::size_t l = 0; l < n; ++l) {
    largest.second = std::max({largest.second, seconds[l], std::min(largest.first, firsts[l])});
    largest.first = std::max(largest.first, firsts[l]);
  }
  return largest;
}

void KeepLargestTwo(const std::int16_t* products, std::size_t rows, std::size_t size, std::int16_t* firsts,
                    std::int16_t* seconds) {
  const I16 d;
  for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
    auto first = hn::Load(d, firsts + i), second = hn::Load(d, seconds + i);
    for (std::size_t t = 0; t < rows; ++t) keep(hn::Load(d, products + t * size + i), first, second);
    hn::Store(first, d, firsts + i);
    hn::Store(second, d, seconds + i);
  }
}

std::size_t PlacesAbove(std::span<const std::int16_t> row, std::int16_t limit, std::int32_t* out) {
  const I16 d;
  const std::size_t n = hn::Lanes(d);
  const auto threshold = hn::Set(d, limit);
  std::size_t count = 0;
  for (std::size_t i = 0; i < row.size(); i += n) {
    const auto above = hn::Gt(hn::Load(d, row.data() + i), threshold);
    if (hn::AllFalse(d, above)) continue;
    std::uint64_t bits = 0;  // one a lane
    hn::StoreMaskBits(d, above, reinterpret_cast<std::uint8_t*>(&bits));
    for (; bits != 0; bits &= bits - 1)
      out[count++] = static_cast<std::int32_t>(i + hwy::Num0BitsBelowLS1Bit_Nonzero64(bits));
  }
  return count;
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {

HWY_EXPORT(ByteProducts);
HWY_EXPORT(LargestTwo);
HWY_EXPORT(KeepLargestTwo);
HWY_EXPORT(PlacesAbove);

void byte_products(const RefBytes& refs, std::size_t first, const CurBytes& curs, std::int16_t* products) {
  HWY_DYNAMIC_DISPATCH(ByteProducts)(refs, first, curs, products);
}

TwoLargest two_largest(std::span<const std::int16_t> row) {
  return HWY_DYNAMIC_DISPATCH(LargestTwo)(row);
}

void keep_two_largest(const std::int16_t* products, std::size_t rows, std::size_t size, std::int16_t* first,
                      std::int16_t* second) {
  HWY_DYNAMIC_DISPATCH(KeepLargestTwo)(products, rows, size, first, second);
}

std::size_t places_above(std::span<const std::int16_t> row, std::int16_t limit, std::int32_t* out) {
  return HWY_DYNAMIC_DISPATCH(PlacesAbove)(row, limit, out);
}

}  // namespace heel
#endif  // HWY_ONCE
