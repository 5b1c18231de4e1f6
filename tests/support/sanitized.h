// For tests that do less under the sanitizers, where pictures take ten times as long (thread sanitizer: fifty
// times).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace heel::test {

#if defined(__SANITIZE_THREAD__)
inline constexpr bool kThreadSanitizer = true;
#else
inline constexpr bool kThreadSanitizer = false;
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// `cases`; under the sanitizers the first `count` of them.
template <typename Case>
std::vector<Case> fewer_if_sanitized(std::vector<Case> cases, std::size_t count) {
  if (kSanitized)
    cases.erase(cases.begin() + static_cast<std::ptrdiff_t>(std::min(count, cases.size())), cases.end());
  return cases;
}

}  // namespace heel::test
