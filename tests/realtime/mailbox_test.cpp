// The mailbox gives the newest value, whole, once.
#include "realtime/mailbox.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

namespace heel {
namespace {

struct Letter {
  std::uint64_t number = 0;
  std::array<std::uint64_t, 20> copies{};
};

Letter letter(std::uint64_t number) {
  Letter result{.number = number};
  for (std::size_t i = 0; i < result.copies.size(); ++i) result.copies[i] = number + i;
  return result;
}

bool whole(const Letter& value) {
  for (std::size_t i = 0; i < value.copies.size(); ++i) {
    if (value.copies[i] != value.number + i) return false;
  }
  return true;
}

TEST(Mailbox, AnEmptyMailboxDoesNotChangeTheReadersValue) {
  Mailbox<Letter> box;
  Letter out = letter(7);
  EXPECT_FALSE(box.take(out));
  EXPECT_EQ(out.number, 7u);
}

TEST(Mailbox, GivesTheNewestValueOnce) {
  Mailbox<Letter> box;
  for (std::uint64_t n = 1; n <= 4; ++n) box.post(letter(n));
  Letter out;
  ASSERT_TRUE(box.take(out));
  EXPECT_EQ(out.number, 4u);
  EXPECT_FALSE(box.take(out));
  box.post(letter(5));
  ASSERT_TRUE(box.take(out));
  EXPECT_EQ(out.number, 5u);
}

TEST(Mailbox, UnderStressValuesAreWholeNeverGoBackwardsAndTheLastArrives) {
  Mailbox<Letter> box;
  constexpr std::uint64_t kLetters = 200'000;
  std::atomic<bool> done{false};
  std::jthread writer([&] {
    for (std::uint64_t n = 1; n <= kLetters; ++n) box.post(letter(n));
    done.store(true);
  });
  Letter out;
  std::uint64_t last = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  bool finished = false;
  while (!finished) {
    finished = done.load();  // one more take after the end
    if (!box.take(out)) continue;
    torn += whole(out) ? 0 : 1;
    backwards += out.number > last ? 0 : 1;
    last = out.number;
  }
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(last, kLetters);
}

}  // namespace
}  // namespace heel
