// What a fuzz target demands beside the sanitizers' checks: the program ends where it does not hold.
#pragma once

#include <cstdlib>

namespace heel::test {

inline void require(bool holds) {
  if (!holds) std::abort();
}

}  // namespace heel::test
