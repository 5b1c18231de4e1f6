#include "vision/features/simd_target.h"

#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vision/features/simd_target.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace heel::HWY_NAMESPACE {
namespace {

const char* OwnName() {
  return hwy::TargetName(HWY_TARGET);
}

}  // namespace
}  // namespace heel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace heel {
namespace {

std::vector<std::int64_t> separated(std::int64_t targets) {
  std::vector<std::int64_t> all;
  for (; targets != 0; targets &= targets - 1)
    all.push_back(targets & -targets);  // lower bits are better sets
  return all;
}

// The static target is what the compiler assumes of every processor. Highway does not report it as supported
// if it also names an extension that is not used here (NEON with AES).
std::vector<std::int64_t> available() {
  return separated(HWY_TARGETS & (hwy::SupportedTargets() | HWY_STATIC_TARGET));
}

std::vector<std::string_view> names_of(const std::vector<std::int64_t>& targets) {
  std::vector<std::string_view> names;
  names.reserve(targets.size());
  for (const std::int64_t target : targets) names.emplace_back(hwy::TargetName(target));
  return names;
}

}  // namespace

HWY_EXPORT(OwnName);

const char* simd_target_name() {
  return HWY_DYNAMIC_DISPATCH(OwnName)();
}

std::vector<std::string_view> compiled_simd_targets() {
  return names_of(separated(HWY_TARGETS));
}

std::vector<std::string_view> available_simd_targets() {
  return names_of(available());
}

bool use_simd_target(std::string_view name) {
  for (const std::int64_t target : available()) {
    if (name != hwy::TargetName(target)) continue;
    hwy::GetChosenTarget().Update(target);
    return true;
  }
  return false;
}

void use_best_simd_target() {
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace heel
#endif  // HWY_ONCE
