// What the lock-free parts are made of. The tests put their own policy here, which runs every interleaving of
// small cases and every value that a load may see (tests/realtime/explorer.h).
#pragma once

#include <atomic>

namespace heel {

struct StdMemory {
  template <typename T>
  using Atomic = std::atomic<T>;
  /// A value that is not atomic and that two threads access one after the other.
  template <typename T>
  using Record = T;
};

}  // namespace heel
