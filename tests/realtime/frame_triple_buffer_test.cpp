// The frame triple buffer: the reader gets the newest frame, frames are whole, and every frame is counted.
#include "realtime/frame_triple_buffer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>
#include <vector>

#include "realtime/clock.h"

namespace heel {
namespace {

constexpr std::uint32_t kWidth = 61;  // odd, so that the stride is larger than the width
constexpr std::uint32_t kHeight = 7;

// Every pixel of a frame is a function of its sequence and place, so that a mixture of two frames shows.
std::uint8_t pixel_of(std::uint64_t sequence, std::uint32_t x, std::uint32_t y) {
  return static_cast<std::uint8_t>(sequence * 131 + (sequence >> 8) * 29 + y * 17 + x * 3);
}

void fill(const WritableFrame& slot, std::uint64_t sequence) {
  *slot.header = {.sequence = sequence,
                  .t_capture_ns = static_cast<TimeNs>(sequence) * 1000,
                  .width_px = kWidth,
                  .height_px = kHeight};
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x)
      slot.grey[y * slot.stride_bytes + x] = pixel_of(sequence, x, y);
  }
}

bool whole(const FrameView& frame) {
  if (frame.header.t_capture_ns != static_cast<TimeNs>(frame.header.sequence) * 1000) return false;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      if (frame.grey[y * frame.stride_bytes + x] != pixel_of(frame.header.sequence, x, y)) return false;
    }
  }
  return true;
}

TEST(FrameTripleBuffer, EmptyAtFirst) {
  FrameTripleBuffer ring(kWidth, kHeight);
  EXPECT_EQ(ring.take(), nullptr);
  EXPECT_FALSE(ring.wait(0));
  EXPECT_EQ(ring.captured(), 0u);
}

TEST(FrameTripleBuffer, TheReaderGetsTheNewestFrameAndReplacedFramesAreCounted) {
  FrameTripleBuffer ring(kWidth, kHeight);
  for (std::uint64_t sequence = 1; sequence <= 5; ++sequence) {
    fill(ring.writable(), sequence);
    ring.publish();
  }
  const FrameView* frame = ring.take();
  ASSERT_NE(frame, nullptr);
  EXPECT_EQ(frame->header.sequence, 5u);
  EXPECT_TRUE(whole(*frame));
  EXPECT_EQ(ring.take(), nullptr) << "the same frame is not given twice";
  EXPECT_EQ(ring.captured(), 5u);
  EXPECT_EQ(ring.consumed(), 1u);
  EXPECT_EQ(ring.dropped(), 4u);
}

TEST(FrameTripleBuffer, TheReadersFrameIsNotChangedByNewerFrames) {
  FrameTripleBuffer ring(kWidth, kHeight);
  fill(ring.writable(), 1);
  ring.publish();
  const FrameView* held = ring.take();
  ASSERT_NE(held, nullptr);
  for (std::uint64_t sequence = 2; sequence < 50; ++sequence) {
    fill(ring.writable(), sequence);
    ring.publish();
    ASSERT_EQ(held->header.sequence, 1u);
    ASSERT_TRUE(whole(*held)) << "overwritten by frame " << sequence;
  }
  EXPECT_EQ(ring.take()->header.sequence, 49u);
}

TEST(FrameTripleBuffer, PushCopiesRowsOfAnotherStrideAndRefusesTooLargeFrames) {
  FrameTripleBuffer ring(kWidth, kHeight);
  const std::uint32_t stride = 100;
  std::vector<std::uint8_t> pixels(stride * kHeight);
  FrameHeader header;
  fill({&header, pixels.data(), stride}, 9);
  ASSERT_TRUE(ring.push({header, pixels.data(), stride}));
  const FrameView* frame = ring.take();
  ASSERT_NE(frame, nullptr);
  EXPECT_TRUE(whole(*frame));

  header.width_px = kWidth + 1;
  EXPECT_FALSE(ring.push({header, pixels.data(), stride}));
  header.width_px = kWidth;
  header.height_px = kHeight + 1;
  EXPECT_FALSE(ring.push({header, pixels.data(), stride}));
  EXPECT_EQ(ring.captured(), 1u);
  EXPECT_EQ(ring.take(), nullptr);
}

TEST(FrameTripleBuffer, WaitEndsWithAFrameAWakeOrTheTimeout) {
  FrameTripleBuffer ring(kWidth, kHeight);
  const TimeNs before_ns = monotonic_now_ns();
  EXPECT_FALSE(ring.wait(20 * kNsPerMs));
  EXPECT_GE(monotonic_now_ns() - before_ns, 19 * kNsPerMs);

  std::jthread writer([&ring] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    fill(ring.writable(), 1);
    ring.publish();
  });
  EXPECT_TRUE(ring.wait(60 * kNsPerS));
  EXPECT_NE(ring.take(), nullptr);

  std::jthread waker([&ring] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ring.wake();
  });
  const TimeNs wake_ns = monotonic_now_ns();
  EXPECT_FALSE(ring.wait(60 * kNsPerS));
  EXPECT_LT(monotonic_now_ns() - wake_ns, 30 * kNsPerS);
}

TEST(FrameTripleBuffer, WaitReturnsAtOnceWhenAFrameIsUnread) {
  FrameTripleBuffer ring(kWidth, kHeight);
  fill(ring.writable(), 1);
  ring.publish();
  const TimeNs before_ns = monotonic_now_ns();
  EXPECT_TRUE(ring.wait(20 * kNsPerS));
  EXPECT_LT(monotonic_now_ns() - before_ns, 15 * kNsPerS);
}

// Writer and reader at full speed; the reader is sometimes as slow as vision.
TEST(FrameTripleBuffer, UnderStressFramesAreWholeAndCountsAddUp) {
  FrameTripleBuffer ring(kWidth, kHeight);
  constexpr std::uint64_t kFrames = 40'000;
  std::atomic<bool> done{false};
  std::jthread writer([&] {
    for (std::uint64_t sequence = 1; sequence <= kFrames; ++sequence) {
      fill(ring.writable(), sequence);
      ring.publish();
      if (sequence % 64 == 0) std::this_thread::yield();
    }
    done.store(true);
    ring.wake();
  });

  std::uint64_t last = 0;
  std::uint64_t torn = 0;
  std::uint64_t backwards = 0;
  std::uint64_t taken = 0;
  while (!done.load()) {
    if (!ring.wait(kNsPerMs)) continue;
    const FrameView* frame = ring.take();
    if (frame == nullptr) continue;
    ++taken;
    if (taken % 100 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
    torn += whole(*frame) ? 0 : 1;
    backwards += frame->header.sequence > last ? 0 : 1;
    last = frame->header.sequence;
  }
  writer.join();
  const std::uint64_t left = ring.wait(0) ? 1 : 0;

  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(ring.captured(), kFrames);
  EXPECT_EQ(ring.consumed(), taken);
  EXPECT_EQ(ring.captured(), ring.consumed() + ring.dropped() + left);
  if (left == 1) last = ring.take()->header.sequence;
  EXPECT_EQ(last, kFrames) << "the newest frame must not be lost";
}

}  // namespace
}  // namespace heel
