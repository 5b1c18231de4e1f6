// The matcher behind heel/matching.h: one exhaustive comparison a Laplacian sign, then ratio and mutual
// check.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "heel/matching.h"
#include "vision/nearest_neighbours.h"

namespace heel {
namespace {

float distance_of(float inner_product) {
  return std::sqrt(std::max(0.f, 2.f - 2.f * inner_product));
}

void members_of_sign(const FeatureSet& set, std::size_t max_count, bool dark,
                     std::vector<std::int32_t>& members) {
  members.clear();
  const std::size_t count = std::min(set.features.size(), max_count);
  for (std::size_t i = 0; i < count; ++i) {
    if ((set.features[i].laplacian > 0) == dark) members.push_back(static_cast<std::int32_t>(i));
  }
}

}  // namespace

struct Matcher::Impl {
  Impl(std::size_t ref_capacity, std::size_t cur_capacity, const MatchSettings& given)
      : settings(given),
        max_ref(ref_capacity),
        max_cur(cur_capacity),
        packed(static_cast<int>(cur_capacity)),
        of_ref(ref_capacity),
        of_cur(static_cast<int>(cur_capacity)) {
    ref_members.reserve(ref_capacity);
    cur_members.reserve(cur_capacity);
  }

  void match_sign(const FeatureSet& ref, const FeatureSet& cur, bool dark, std::vector<Match>& out);

  MatchSettings settings;
  std::size_t max_ref, max_cur;
  DescriptorBlocks packed;
  std::vector<Nearest> of_ref;
  NearestRefs of_cur;
  std::vector<std::int32_t> ref_members, cur_members;
};

void Matcher::Impl::match_sign(const FeatureSet& ref, const FeatureSet& cur, bool dark,
                               std::vector<Match>& out) {
  members_of_sign(ref, max_ref, dark, ref_members);
  members_of_sign(cur, max_cur, dark, cur_members);
  if (ref_members.empty() || cur_members.empty()) return;
  packed.pack(cur.descriptors, cur_members);
  const std::span<Nearest> nearest_of_ref(of_ref.data(), ref_members.size());
  find_nearest(ref.descriptors, ref_members, packed, nearest_of_ref, of_cur);
  for (std::size_t i = 0; i < ref_members.size(); ++i) {
    const Nearest& nearest = nearest_of_ref[i];
    const float distance = distance_of(nearest.best);
    if (cur_members.size() > 1 && !(distance < settings.ratio * distance_of(nearest.second))) continue;
    const auto found = static_cast<std::size_t>(nearest.index);
    if (settings.mutual && of_cur.index[found] != static_cast<std::int32_t>(i)) continue;
    out.push_back({ref_members[i], cur_members[found], distance});
  }
}

Matcher::Matcher(int max_ref, int max_cur, const MatchSettings& settings)
    : impl_(std::make_unique<Impl>(static_cast<std::size_t>(std::max(0, max_ref)),
                                   static_cast<std::size_t>(std::max(0, max_cur)), settings)) {}
Matcher::~Matcher() = default;
Matcher::Matcher(Matcher&&) noexcept = default;
Matcher& Matcher::operator=(Matcher&&) noexcept = default;

void Matcher::match(const FeatureSet& ref, const FeatureSet& cur, std::vector<Match>& out) {
  out.clear();
  impl_->match_sign(ref, cur, true, out);
  impl_->match_sign(ref, cur, false, out);
  std::sort(out.begin(), out.end(), [](const Match& a, const Match& b) { return a.ref < b.ref; });
}

}  // namespace heel
