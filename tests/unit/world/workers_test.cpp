// Work shared among threads: every piece is done once, whoever does it.
#include "heel-sim/camera/workers.h"

#include <gtest/gtest.h>

namespace heel::sim {
namespace {

TEST(Workers, EveryPieceIsDoneOnce) {
  for (const int threads : {1, 2, 5}) {
    Workers workers(threads);
    EXPECT_EQ(workers.threads(), threads);
    for (const int count : {0, 1, 7, 480})
      for (int round = 0; round < 50; ++round) {
        std::vector<std::atomic<int>> done(static_cast<std::size_t>(count));
        workers.share(count, 3, [&](int begin, int end) {
          for (int i = begin; i < end; ++i) ++done[static_cast<std::size_t>(i)];
        });
        for (const std::atomic<int>& times : done) ASSERT_EQ(times, 1);
      }
  }
}

TEST(Workers, AtLeastTheCallerWorks) {
  EXPECT_GE(Workers(0).threads(), 1);
  EXPECT_LE(Workers(0).threads(), 4);
}

}  // namespace
}  // namespace heel::sim
