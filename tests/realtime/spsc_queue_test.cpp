// The record queue: records arrive in order and once, and dropped records are counted.
#include "realtime/spsc_queue.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace heel {
namespace {

TEST(SpscQueue, FirstInFirstOutAcrossTheWrap) {
  SpscQueue<int> queue(4);
  int out = 0;
  EXPECT_FALSE(queue.pop(out));
  for (int round = 0; round < 10; ++round) {
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(queue.push(round * 3 + i));
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(queue.pop(out));
      EXPECT_EQ(out, round * 3 + i);
    }
  }
  EXPECT_FALSE(queue.pop(out));
  EXPECT_EQ(queue.dropped(), 0u);
}

TEST(SpscQueue, WhenFullTheNewRecordIsDroppedAndCounted) {
  SpscQueue<int> queue(4);
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(queue.push(i));
  EXPECT_FALSE(queue.push(4));
  EXPECT_FALSE(queue.push(5));
  EXPECT_EQ(queue.dropped(), 2u);
  int out = -1;
  ASSERT_TRUE(queue.pop(out));
  EXPECT_EQ(out, 0);
  EXPECT_TRUE(queue.push(6));
}

TEST(SpscQueue, CapacityIsRoundedUpToAPowerOfTwo) {
  EXPECT_EQ(SpscQueue<int>(0).capacity(), 2u);
  EXPECT_EQ(SpscQueue<int>(5).capacity(), 8u);
  EXPECT_EQ(SpscQueue<int>(8).capacity(), 8u);
}

struct Record {
  std::uint64_t number = 0;
  std::array<std::uint64_t, 12> copies{};
};

TEST(SpscQueue, UnderStressRecordsAreWholeInOrderAndCountsAddUp) {
  SpscQueue<Record> queue(32);
  constexpr std::uint64_t kRecords = 200'000;
  std::uint64_t pushed = 0;
  std::atomic<bool> done{false};
  std::jthread writer([&] {
    Record record;
    for (record.number = 1; record.number <= kRecords; ++record.number) {
      record.copies.fill(record.number);
      pushed += queue.push(record) ? 1 : 0;
      if (record.number % 50 == 0) std::this_thread::yield();
    }
    done.store(true);
  });
  std::uint64_t popped = 0;
  std::uint64_t last = 0;
  std::uint64_t wrong = 0;
  Record out;
  for (bool finished = false; !finished;) {
    finished = done.load();
    while (queue.pop(out)) {
      ++popped;
      wrong += out.number > last ? 0 : 1;
      for (const std::uint64_t copy : out.copies) wrong += copy == out.number ? 0 : 1;
      last = out.number;
    }
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(popped, pushed);
  EXPECT_EQ(pushed + queue.dropped(), kRecords);
}

}  // namespace
}  // namespace heel
