// Runs a test's body on every instruction set.
#pragma once

#include <gtest/gtest.h>

#include "vision/features/simd_target.h"

namespace heel::test {

/// Runs `body` once for each instruction set that heel is compiled for and this processor has, with only that
/// one enabled.
template <typename Body>
void for_each_simd_target(Body body) {
  ASSERT_FALSE(available_simd_targets().empty());
  for (const std::string_view target : available_simd_targets()) {
    SCOPED_TRACE(target);
    ASSERT_TRUE(use_simd_target(target));
    body();
    use_best_simd_target();
  }
}

}  // namespace heel::test
