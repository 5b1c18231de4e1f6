// The matcher of heel/matching.h: for each Laplacian sign one exhaustive comparison, then ratio test and
// mutual check. For unit descriptors |a − b|² = 2 − 2 a·b: the nearest has the largest inner product. All
// products are first computed from bytes, with known bounds of their error; only where these bounds leave a
// decision open are floats compared.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "heel/matching.h"
#include "vision/matching/byte_products.h"

namespace heel {
namespace {

constexpr float kFloatError = 1e-5f;  // bounds the rounding error of a sum of 64 floats
constexpr float kUnitError = 2.f;     // bounds the error of a byte product from rounding its excesses

float distance_of(float inner_product) {
  return std::sqrt(std::max(0.f, 2.f - 2.f * inner_product));
}

float product_of(float distance) {
  return 1.f - 0.5f * distance * distance;
}

/// Bounds of the exact product, from a byte product whose distance is wrong by at most `error`.
float upper_bound(std::int16_t byte_product, float error) {
  const float units = static_cast<float>(byte_product);
  return product_of(std::max(0.f, distance_of((units + kUnitError) / kProductUnit) - error)) + kFloatError;
}
float lower_bound(std::int16_t byte_product, float error) {
  const float units = static_cast<float>(byte_product);
  return product_of(distance_of((units - kUnitError) / kProductUnit) + error) - kFloatError;
}

/// Summed in a fixed order: the same to the bit on every instruction set.
float inner_product(const Descriptor& a, const Descriptor& b) {
  std::array<float, 8> sums{};
  for (std::size_t k = 0; k < kDescriptorSize; k += sums.size())
    for (std::size_t l = 0; l < sums.size(); ++l) sums[l] += a[k + l] * b[k + l];
  return ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
}

const Descriptor& descriptor_of(const FeatureSet& set, std::int32_t feature) {
  return set.descriptors[static_cast<std::size_t>(feature)];
}

/// Without a branch for each feature, which would be wrong for every second one.
void members_of_sign(const FeatureSet& set, std::size_t max_count, bool dark,
                     std::vector<std::int32_t>& members) {
  const std::size_t count = std::min(set.features.size(), max_count);
  members.resize(count);
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; ++i) {
    members[found] = static_cast<std::int32_t>(i);
    found += (set.features[i].laplacian > 0) == dark ? 1 : 0;
  }
  members.resize(found);
}

}  // namespace

struct Matcher::Impl {
  // A ref and its nearest cur, by their places among the members.
  struct Candidate {
    std::int32_t ref = 0, cur = -1;
    float product = -2.f;
    std::int16_t byte_product = kAbsentProduct;
  };
  // The byte products of one ref with all curs. `ref_error` is of the ref alone; `error` bounds that of every
  // distance in the row.
  struct Row {
    const Descriptor& ref;
    std::span<const std::int16_t> products;
    TwoLargest largest;
    float ref_error;
    float error;
  };
  // The largest exact product of a row, and a lower bound of the next.
  struct LargestExact {
    std::int32_t place = -1;
    float product = -2.f;
    float next = -2.f;
  };

  Impl(std::size_t ref_capacity, std::size_t cur_capacity, const MatchSettings& given)
      : settings(given),
        max_ref(ref_capacity),
        max_cur(cur_capacity),
        ref_bytes(ref_capacity),
        cur_bytes(cur_capacity),
        products(hwy::AllocateAligned<std::int16_t>(padded() * kByteTile)),
        cur_first(hwy::AllocateAligned<std::int16_t>(padded())),
        cur_second(hwy::AllocateAligned<std::int16_t>(padded())),
        places(padded()) {
    ref_members.reserve(ref_capacity);
    cur_members.reserve(cur_capacity);
    candidates.reserve(ref_capacity);
    dark_matches.reserve(ref_capacity);
    bright_matches.reserve(ref_capacity);
  }

  void match_features_of_sign(const FeatureSet& ref, const FeatureSet& cur, bool dark);
  void find_candidates(const FeatureSet& ref, const FeatureSet& cur);
  bool passes_ratio(float best, float second) const {
    return distance_of(best) < settings.ratio * distance_of(second);
  }
  bool cannot_pass_ratio(const Row& row) const;
  bool passes_ratio(const Row& row, const LargestExact& nearest, const FeatureSet& cur);
  LargestExact largest_exact(const Row& row, std::int16_t largest, std::int32_t left_out,
                             const FeatureSet& cur);
  bool is_nearest_of_cur(const Candidate& candidate, const FeatureSet& ref, const FeatureSet& cur) const;

  std::size_t padded() const { return CurBytes::padded(std::max<std::size_t>(1, max_cur)); }
  float error_with(float ref_error) const { return ref_error + cur_bytes.max_error(); }

  MatchSettings settings;
  std::size_t max_ref, max_cur;
  RefBytes ref_bytes;
  CurBytes cur_bytes;
  hwy::AlignedFreeUniquePtr<std::int16_t[]> products;               // of one tile of refs
  hwy::AlignedFreeUniquePtr<std::int16_t[]> cur_first, cur_second;  // the two largest of every cur
  std::vector<std::int32_t> places, ref_members, cur_members;
  std::vector<Candidate> candidates;
  std::vector<Match> dark_matches, bright_matches;  // in the order of the refs
};

bool Matcher::Impl::cannot_pass_ratio(const Row& row) const {
  return cur_members.size() > 1 &&
         !passes_ratio(upper_bound(row.largest.first, row.error), lower_bound(row.largest.second, row.error));
}

/// Among the places of a row but `left_out`, of whose byte products `largest` is the largest; of equals the
/// first. The exact product of that place is a sharp bound: few others can reach it.
Matcher::Impl::LargestExact Matcher::Impl::largest_exact(const Row& row, std::int16_t largest,
                                                         std::int32_t left_out, const FeatureSet& cur) {
  const auto exact = [&](std::int32_t place) {
    return inner_product(row.ref, descriptor_of(cur, cur_members[static_cast<std::size_t>(place)]));
  };
  const auto places_above_product = [&](float limit) {
    const auto above = static_cast<std::int16_t>(std::max(limit, float{kAbsentProduct}));
    return std::span<const std::int32_t>(places.data(), places_above(row.products, above, places.data()));
  };
  float least = -1.f;
  for (const std::int32_t place : places_above_product(static_cast<float>(largest) - 1.f)) {
    if (place == left_out || row.products[static_cast<std::size_t>(place)] != largest) continue;
    least = exact(place);
    break;
  }
  const float distance = distance_of(least) + row.error;
  LargestExact found;
  for (const std::int32_t place :
       places_above_product(std::floor((product_of(distance) - kFloatError) * kProductUnit) - kUnitError)) {
    const auto member = static_cast<std::size_t>(place);
    if (place == left_out ||
        upper_bound(row.products[member], row.ref_error + cur_bytes.error(member)) < least)
      continue;
    const float product = exact(place);
    found.next = std::max(found.next, std::min(product, found.product));
    if (product <= found.product) continue;
    found.product = product;
    found.place = place;
  }
  return found;
}

bool Matcher::Impl::passes_ratio(const Row& row, const LargestExact& nearest, const FeatureSet& cur) {
  if (cur_members.size() < 2) return true;
  if (!passes_ratio(nearest.product, nearest.next)) return false;
  const bool largest = row.products[static_cast<std::size_t>(nearest.place)] == row.largest.first;
  const std::int16_t others = largest ? row.largest.second : row.largest.first;
  if (passes_ratio(nearest.product, upper_bound(others, row.error))) return true;
  if (!passes_ratio(nearest.product, lower_bound(others, row.error))) return false;
  return passes_ratio(nearest.product, largest_exact(row, others, nearest.place, cur).product);
}

void Matcher::Impl::find_candidates(const FeatureSet& ref, const FeatureSet& cur) {
  const std::size_t stride = CurBytes::padded(cur_members.size());
  std::fill_n(cur_first.get(), stride, kAbsentProduct);
  std::fill_n(cur_second.get(), stride, kAbsentProduct);
  candidates.clear();
  for (std::size_t first = 0; first < ref_members.size(); first += kByteTile) {
    const std::size_t tile = std::min(kByteTile, ref_members.size() - first);
    byte_products(ref_bytes, first, cur_bytes, products.get());
    keep_two_largest(products.get(), tile, stride, cur_first.get(), cur_second.get());
    for (std::size_t i = first; i < first + tile; ++i) {
      const std::span<const std::int16_t> of_ref(products.get() + (i - first) * stride, stride);
      const Row row{descriptor_of(ref, ref_members[i]), of_ref, two_largest(of_ref), ref_bytes.error(i),
                    error_with(ref_bytes.error(i))};
      if (cannot_pass_ratio(row)) continue;
      const LargestExact nearest = largest_exact(row, row.largest.first, -1, cur);
      if (passes_ratio(row, nearest, cur))
        candidates.push_back({static_cast<std::int32_t>(i), nearest.place, nearest.product,
                              of_ref[static_cast<std::size_t>(nearest.place)]});
    }
  }
}

bool Matcher::Impl::is_nearest_of_cur(const Candidate& candidate, const FeatureSet& ref,
                                      const FeatureSet& cur) const {
  const auto member = static_cast<std::size_t>(candidate.cur);
  const bool largest = candidate.byte_product == cur_first[member];
  const std::int16_t others = largest ? cur_second[member] : cur_first[member];
  const float error = ref_bytes.max_error() + cur_bytes.error(member);
  if (upper_bound(others, error) < candidate.product) return true;
  if (lower_bound(others, error) > candidate.product) return false;
  const Descriptor& descriptor = descriptor_of(cur, cur_members[member]);
  for (std::size_t i = 0; i < ref_members.size(); ++i) {
    const float product = inner_product(descriptor_of(ref, ref_members[i]), descriptor);
    const bool earlier = static_cast<std::int32_t>(i) < candidate.ref;
    if (product > candidate.product || (earlier && product == candidate.product)) return false;
  }
  return true;
}

void Matcher::Impl::match_features_of_sign(const FeatureSet& ref, const FeatureSet& cur, bool dark) {
  std::vector<Match>& out = dark ? dark_matches : bright_matches;
  out.clear();
  members_of_sign(ref, max_ref, dark, ref_members);
  members_of_sign(cur, max_cur, dark, cur_members);
  if (ref_members.empty() || cur_members.empty()) return;
  cur_bytes.pack(cur.descriptors, cur_members);
  ref_bytes.pack(ref.descriptors, ref_members, cur_bytes.centre());
  find_candidates(ref, cur);
  for (const Candidate& candidate : candidates) {
    if (settings.mutual && !is_nearest_of_cur(candidate, ref, cur)) continue;
    out.push_back({ref_members[static_cast<std::size_t>(candidate.ref)],
                   cur_members[static_cast<std::size_t>(candidate.cur)], distance_of(candidate.product)});
  }
}

Matcher::Matcher(int max_ref, int max_cur, const MatchSettings& settings)
    : impl_(std::make_unique<Impl>(static_cast<std::size_t>(std::max(0, max_ref)),
                                   static_cast<std::size_t>(std::max(0, max_cur)), settings)) {}
Matcher::~Matcher() = default;
Matcher::Matcher(Matcher&&) noexcept = default;
Matcher& Matcher::operator=(Matcher&&) noexcept = default;

void Matcher::match(const FeatureSet& ref, const FeatureSet& cur, std::vector<Match>& out) {
  for (const bool dark : {true, false}) impl_->match_features_of_sign(ref, cur, dark);
  out.resize(impl_->dark_matches.size() + impl_->bright_matches.size());
  std::merge(impl_->dark_matches.begin(), impl_->dark_matches.end(), impl_->bright_matches.begin(),
             impl_->bright_matches.end(), out.begin(),
             [](const Match& a, const Match& b) { return a.ref < b.ref; });
}

}  // namespace heel
