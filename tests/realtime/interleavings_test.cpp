// Every interleaving of small cases of the lock-free parts, under the C++ memory model (realtime/explorer.h).
// The classes are those that heeld uses, with another policy for their memory. Weaker orders and a wrong
// ring, planted here, must be found.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "realtime/explorer.h"
#include "realtime/mailbox.h"
#include "realtime/picture_queue.h"
#include "realtime/spsc_queue.h"
#include "support/sanitized.h"

namespace heel {
namespace {

using test::explore;
using test::Explored;
using test::ExploredAtomic;
using test::ExploredMemory;
using test::ExploredRecord;
using test::OneRun;
using test::Planted;
using test::Violation;

void require(bool holds, const std::string& what) {
  if (!holds) throw Violation(what);
}

std::string text_of(const std::vector<int>& values) {
  std::string text;
  for (const int value : values) text += std::to_string(value) + " ";
  return text;
}

/// The reader gets what the writer has put in, in order, and what is left comes out at the end.
template <typename Queue>
OneRun queue_run(int pushes, int pops) {
  struct Shared {
    Queue queue{2};
    std::vector<int> pushed, popped;
  };
  const auto shared = std::make_shared<Shared>();
  OneRun run;
  run.threads = {[shared, pushes] {
                   for (int value = 1; value <= pushes; ++value)
                     if (shared->queue.push(value)) shared->pushed.push_back(value);
                 },
                 [shared, pops] {
                   for (int i = 0, value = 0; i < pops; ++i)
                     if (shared->queue.pop(value)) shared->popped.push_back(value);
                 }};
  run.at_end = [shared, pushes] {
    for (int value = 0; shared->queue.pop(value);) shared->popped.push_back(value);
    require(shared->pushed == shared->popped,
            "pushed " + text_of(shared->pushed) + "popped " + text_of(shared->popped));
    require(shared->queue.dropped() + shared->pushed.size() == static_cast<std::size_t>(pushes), "dropped");
  };
  return run;
}

OneRun spsc_run() {
  return queue_run<SpscQueue<int, ExploredMemory>>(3, 3);
}

/// The reader sees values that only get newer, and at the end the newest.
template <typename Box>
OneRun box_run(int posts, int takes) {
  struct Shared {
    Box box;
    int taken = 0;
  };
  const auto shared = std::make_shared<Shared>();
  const auto take = [shared] {
    int value = 0;
    if (!shared->box.take(value)) return;
    require(value > shared->taken,
            "took " + std::to_string(value) + " after " + std::to_string(shared->taken));
    shared->taken = value;
  };
  OneRun run;
  run.threads = {[shared, posts] {
                   for (int value = 1; value <= posts; ++value) shared->box.post(value);
                 },
                 [take, takes] {
                   for (int i = 0; i < takes; ++i) take();
                 }};
  run.at_end = [shared, take, posts] {
    take();
    require(shared->taken == posts, "the newest is " + std::to_string(shared->taken));
  };
  return run;
}

OneRun mailbox_run() {
  return box_run<Mailbox<int, ExploredMemory>>(3, 3);
}

/// Frames are known by their numbers.
OneRun picture_run() {
  struct Shared {
    BasicPictureQueue<ExploredMemory> queue{2, 2, 1};
    std::vector<std::uint64_t> pushed, popped;
  };
  const auto shared = std::make_shared<Shared>();
  const auto pop = [shared] {
    const FrameView frame = shared->queue.front();
    if (frame.grey == nullptr) return false;
    require(frame.grey[0] == frame.header.sequence, "pixels of another frame");
    shared->popped.push_back(frame.header.sequence);
    shared->queue.pop();
    return true;
  };
  OneRun run;
  run.threads = {[shared] {
                   for (std::uint8_t n = 1; n <= 3; ++n) {
                     FrameHeader header;
                     header.sequence = n;
                     header.width_px = header.height_px = 1;
                     if (shared->queue.push({header, &n, 1})) shared->pushed.push_back(n);
                   }
                 },
                 [pop] {
                   for (int i = 0; i < 3; ++i) pop();
                 }};
  run.at_end = [shared, pop] {
    while (pop()) {
    }
    require(shared->pushed == shared->popped, "frames are lost, or come twice");
  };
  return run;
}

/// Two slots and a position, which triple_buffer.h says would not do.
template <typename T>
class RingOfTwo {
 public:
  void post(const T& value) {
    slots_[(position_ + 1) % 2] = value;
    newest_.store(++position_, std::memory_order_release);
  }
  bool take(T& out) {
    const int newest = newest_.load(std::memory_order_acquire);
    if (newest == taken_) return false;
    taken_ = newest;
    out = slots_[newest % 2];
    return true;
  }

 private:
  ExploredRecord<T> slots_[2];
  ExploredAtomic<int> newest_{0};
  int position_ = 0, taken_ = 0;
};

class Interleavings : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::kSanitized) GTEST_SKIP() << "sanitizers do not follow coroutines; the release tests explore";
  }
};

struct Part {
  const char* name;
  OneRun (*make_run)();
};
constexpr Part kParts[] = {{"SpscQueue", spsc_run}, {"Mailbox", mailbox_run}, {"PictureQueue", picture_run}};

TEST_F(Interleavings, NoneBreaksAQueueOrAMailbox) {
  for (const Part& part : kParts) {
    const Explored explored = explore(part.make_run);
    EXPECT_EQ(explored.violation, "") << part.name << " in run " << explored.runs;
    EXPECT_GT(explored.runs, 100u) << part.name;
    RecordProperty(part.name, static_cast<int>(explored.runs));
  }
}

TEST_F(Interleavings, AStoreThatDoesNotReleaseIsFound) {
  for (const Part& part : kParts)
    EXPECT_NE(explore(part.make_run, Planted::NoRelease).violation.find("data race"), std::string::npos)
        << part.name;
}

TEST_F(Interleavings, ALoadThatDoesNotAcquireIsFound) {
  for (const Part& part : kParts)
    EXPECT_NE(explore(part.make_run, Planted::NoAcquire).violation.find("data race"), std::string::npos)
        << part.name;
}

TEST_F(Interleavings, ARingThatWritesTheSlotBeingReadIsFound) {
  EXPECT_NE(explore([] { return box_run<RingOfTwo<int>>(3, 3); }).violation.find("data race"),
            std::string::npos);
}

/// Message passing with relaxed orders: the reader may see the flag and not the value, and must be shown
/// both.
TEST_F(Interleavings, ALoadMayGiveAnOldStore) {
  struct Shared {
    ExploredAtomic<int> value{0}, flag{0};
  };
  int seen[2][2] = {};
  const auto run_with = [&](std::memory_order store, std::memory_order load) {
    return explore([&, store, load] {
      const auto shared = std::make_shared<Shared>();
      OneRun run;
      run.threads = {[shared, store] {
                       shared->value.store(1, std::memory_order_relaxed);
                       shared->flag.store(1, store);
                     },
                     [shared, load, &seen] {
                       const int flag = shared->flag.load(load);
                       ++seen[flag][shared->value.load(std::memory_order_relaxed)];
                     }};
      return run;
    });
  };
  EXPECT_EQ(run_with(std::memory_order_relaxed, std::memory_order_relaxed).violation, "");
  for (const auto& row : seen)
    for (const int count : row) EXPECT_GT(count, 0);
  std::fill(&seen[0][0], &seen[0][0] + 4, 0);
  run_with(std::memory_order_release, std::memory_order_acquire);
  EXPECT_EQ(seen[1][0], 0);
  EXPECT_GT(seen[1][1], 0);
  EXPECT_GT(seen[0][0], 0);
}

}  // namespace
}  // namespace heel
