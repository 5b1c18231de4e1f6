#include "vision/nearest_neighbours.h"

#include <algorithm>
#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/nearest_neighbours.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using F32 = hn::CappedTag<float, 16>;
using I32 = hn::RebindToSigned<F32>;

constexpr std::size_t kMaxLanes = 16;
constexpr std::size_t kBlock = DescriptorBlocks::kBlock;
constexpr std::size_t kTile = 4;  // refs compared with two vectors of packed descriptors at a time

// Inner products of kTile refs with the 2 · Lanes members from `block` on; eight sums are in flight, as many
// as it takes to keep two multiply-add units busy.
HWY_INLINE void inner_products(const std::array<const float*, kTile>& refs, const float* block,
                               float (&products)[kTile][2 * kMaxLanes]) {
  const F32 d;
  const std::size_t n = hn::Lanes(d);
  auto a0 = hn::Zero(d), a1 = a0, b0 = a0, b1 = a0, c0 = a0, c1 = a0, e0 = a0, e1 = a0;
  for (std::size_t k = 0; k < kDescriptorSize; ++k, block += kBlock) {
    const auto x0 = hn::Load(d, block), x1 = hn::Load(d, block + n);
    const auto a = hn::Set(d, refs[0][k]), b = hn::Set(d, refs[1][k]);
    const auto c = hn::Set(d, refs[2][k]), e = hn::Set(d, refs[3][k]);
    a0 = hn::MulAdd(a, x0, a0);
    a1 = hn::MulAdd(a, x1, a1);
    b0 = hn::MulAdd(b, x0, b0);
    b1 = hn::MulAdd(b, x1, b1);
    c0 = hn::MulAdd(c, x0, c0);
    c1 = hn::MulAdd(c, x1, c1);
    e0 = hn::MulAdd(e, x0, e0);
    e1 = hn::MulAdd(e, x1, e1);
  }
  const auto store = [&](std::size_t t, hn::Vec<F32> low, hn::Vec<F32> high) {
    hn::Store(low, d, products[t]);
    hn::Store(high, d, products[t] + n);
  };
  store(0, a0, a1);
  store(1, b0, b1);
  store(2, c0, c1);
  store(3, e0, e1);
}

// The running two best of every lane, for one ref.
struct LaneBest {
  HWY_ALIGN float best[kMaxLanes];
  HWY_ALIGN float second[kMaxLanes];
  HWY_ALIGN std::int32_t index[kMaxLanes];

  void start() {
    std::fill_n(best, kMaxLanes, -2.f);
    std::fill_n(second, kMaxLanes, -2.f);
    std::fill_n(index, kMaxLanes, -1);
  }
};

HWY_INLINE void keep_best(hn::Vec<F32> product, hn::Vec<I32> index, LaneBest& lanes) {
  const F32 d;
  const I32 di;
  const auto best = hn::Load(d, lanes.best);
  const auto better = hn::RebindMask(di, hn::Gt(product, best));
  hn::Store(hn::Max(hn::Load(d, lanes.second), hn::Min(best, product)), d, lanes.second);
  hn::Store(hn::Max(best, product), d, lanes.best);
  hn::Store(hn::IfThenElse(better, index, hn::Load(di, lanes.index)), di, lanes.index);
}

// For Lanes packed descriptors from `begin` on: who of the tile's refs is nearer than all before.
HWY_INLINE void keep_best_refs(const float (&products)[kTile][2 * kMaxLanes], std::size_t part,
                               std::size_t first_ref, std::size_t refs, std::size_t begin,
                               NearestRefs& nearest) {
  const F32 d;
  const I32 di;
  auto best = hn::Load(d, nearest.best.get() + begin);
  auto index = hn::Load(di, nearest.index.get() + begin);
  for (std::size_t t = 0; t < refs; ++t) {
    const auto product = hn::Load(d, products[t] + part);
    const auto better = hn::RebindMask(di, hn::Gt(product, best));
    index = hn::IfThenElse(better, hn::Set(di, static_cast<std::int32_t>(first_ref + t)), index);
    best = hn::Max(best, product);
  }
  hn::Store(best, d, nearest.best.get() + begin);
  hn::Store(index, di, nearest.index.get() + begin);
}

Nearest reduce(const LaneBest& lanes, std::size_t count) {
  Nearest nearest;
  for (std::size_t l = 0; l < count; ++l) {
    nearest.second = std::max({nearest.second, lanes.second[l], std::min(nearest.best, lanes.best[l])});
    if (lanes.best[l] > nearest.best || (lanes.best[l] == nearest.best && lanes.index[l] < nearest.index)) {
      nearest.best = lanes.best[l];
      nearest.index = lanes.index[l];
    }
  }
  return nearest;
}

// One tile of refs against one block: products, then what refs and packed descriptors learn from them.
HWY_INLINE void compare(const std::array<const float*, kTile>& refs, std::size_t first_ref, std::size_t tile,
                        const DescriptorBlocks& packed, int block, std::array<LaneBest, kTile>& best,
                        NearestRefs& of_packed) {
  const F32 d;
  const I32 di;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float products[kTile][2 * kMaxLanes];
  for (std::size_t pair = 0; pair < kBlock; pair += 2 * lanes) {
    inner_products(refs, packed.block(block) + pair, products);
    for (std::size_t part = 0; part < 2 * lanes; part += lanes) {
      const std::size_t begin = static_cast<std::size_t>(block) * kBlock + pair + part;
      const auto index = hn::Iota(di, static_cast<std::int32_t>(begin));
      const auto present = hn::RebindMask(d, hn::Lt(index, hn::Set(di, packed.count())));
      for (std::size_t t = 0; t < tile; ++t) {
        const auto product = hn::Load(d, products[t] + part);
        keep_best(hn::IfThenElse(present, product, hn::Set(d, -2.f)), index, best[t]);
      }
      keep_best_refs(products, part, first_ref, tile, begin, of_packed);
    }
  }
}

void FindNearest(std::span<const Descriptor> refs, std::span<const std::int32_t> ref_index,
                 const DescriptorBlocks& packed, std::span<Nearest> of_ref, NearestRefs& of_packed) {
  const std::size_t padded = static_cast<std::size_t>(packed.blocks()) * kBlock;
  std::fill_n(of_packed.best.get(), padded, -2.f);
  std::fill_n(of_packed.index.get(), padded, -1);
  for (std::size_t first = 0; first < ref_index.size(); first += kTile) {
    const std::size_t tile = std::min(kTile, ref_index.size() - first);
    std::array<const float*, kTile> tile_refs;
    std::array<LaneBest, kTile> best;
    for (std::size_t t = 0; t < kTile; ++t) {
      const std::int32_t ref =
          ref_index[first + std::min(t, tile - 1)];  // the last again where there are fewer
      tile_refs[t] = refs[static_cast<std::size_t>(ref)].data();
      best[t].start();
    }
    for (int b = 0; b < packed.blocks(); ++b) compare(tile_refs, first, tile, packed, b, best, of_packed);
    for (std::size_t t = 0; t < tile; ++t) of_ref[first + t] = reduce(best[t], hn::Lanes(F32()));
  }
}

// Transposes one block, four members at a time: interleaved, four elements k of four members are 16 floats.
void PackBlock(const std::array<const float*, kBlock>& members, float* out) {
  const hn::FixedTag<float, 4> d;
  HWY_ALIGN float four[16];
  for (std::size_t m = 0; m < kBlock; m += 4) {
    for (std::size_t k = 0; k < kDescriptorSize; k += 4) {
      const auto load = [&](std::size_t i) { return hn::LoadU(d, members[m + i] + k); };
      hn::StoreInterleaved4(load(0), load(1), load(2), load(3), d, four);
      for (std::size_t i = 0; i < 4; ++i) hn::Store(hn::Load(d, four + 4 * i), d, out + (k + i) * kBlock + m);
    }
  }
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {
namespace {

constexpr Descriptor kAbsent{};

std::size_t padded(int count) {
  constexpr int kBlock = DescriptorBlocks::kBlock;
  return static_cast<std::size_t>((count + kBlock - 1) / kBlock * kBlock);
}

}  // namespace

HWY_EXPORT(FindNearest);
HWY_EXPORT(PackBlock);

DescriptorBlocks::DescriptorBlocks(int max_count)
    : data_(hwy::AllocateAligned<float>(padded(max_count) * kDescriptorSize)) {}

void DescriptorBlocks::pack(std::span<const Descriptor> descriptors, std::span<const std::int32_t> index) {
  count_ = static_cast<int>(index.size());
  for (int b = 0; b < blocks(); ++b) {
    std::array<const float*, kBlock> members;
    for (std::size_t m = 0; m < kBlock; ++m) {
      const std::size_t i = static_cast<std::size_t>(b) * kBlock + m;
      members[m] = i < index.size() ? descriptors[static_cast<std::size_t>(index[i])].data() : kAbsent.data();
    }
    HWY_DYNAMIC_DISPATCH(PackBlock)
    (members, data_.get() + static_cast<std::size_t>(b) * kBlock * kDescriptorSize);
  }
}

NearestRefs::NearestRefs(int max_count)
    : best(hwy::AllocateAligned<float>(padded(max_count))),
      index(hwy::AllocateAligned<std::int32_t>(padded(max_count))) {}

void find_nearest(std::span<const Descriptor> refs, std::span<const std::int32_t> ref_index,
                  const DescriptorBlocks& packed, std::span<Nearest> of_ref, NearestRefs& of_packed) {
  HWY_DYNAMIC_DISPATCH(FindNearest)(refs, ref_index, packed, of_ref, of_packed);
}

}  // namespace heel
#endif  // HWY_ONCE
