// Copies of frames between two threads: in order, whole, and what does not fit is counted.
#include "realtime/picture_queue.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace heel {
namespace {

constexpr std::uint32_t kWidth_px = 20, kHeight_px = 10, kStride_bytes = 32;

/// Every pixel is the low byte of the frame's number.
class Frame {
 public:
  explicit Frame(std::uint64_t sequence, std::uint32_t width_px = kWidth_px)
      : pixels_(std::size_t{kStride_bytes} * kHeight_px, 255) {
    for (std::uint32_t row = 0; row < kHeight_px; ++row)
      for (std::uint32_t x = 0; x < std::min(width_px, kStride_bytes); ++x)
        pixels_[row * kStride_bytes + x] = static_cast<std::uint8_t>(sequence);
    view.header = {sequence, static_cast<TimeNs>(sequence) * 10, width_px, kHeight_px};
    view.grey = pixels_.data();
    view.stride_bytes = kStride_bytes;
  }
  FrameView view;

 private:
  std::vector<std::uint8_t> pixels_;
};

TEST(PictureQueue, KeepsFramesWithoutTheGapsOfTheirRows) {
  PictureQueue queue(2, kWidth_px, kHeight_px);
  EXPECT_EQ(queue.front().grey, nullptr);
  EXPECT_TRUE(queue.push(Frame(1).view));
  EXPECT_TRUE(queue.push(Frame(2).view));
  EXPECT_FALSE(queue.push(Frame(3).view)) << "full";
  EXPECT_EQ(queue.dropped(), 1u);
  for (const std::uint64_t sequence : {1u, 2u}) {
    const FrameView frame = queue.front();
    ASSERT_EQ(frame.header.sequence, sequence);
    EXPECT_EQ(frame.stride_bytes, kWidth_px);
    for (std::uint32_t i = 0; i < kWidth_px * kHeight_px; ++i) ASSERT_EQ(frame.grey[i], sequence);
    queue.pop();
  }
  EXPECT_EQ(queue.front().grey, nullptr);
  EXPECT_FALSE(queue.push(Frame(4, kWidth_px + 1).view)) << "larger than a slot";
  EXPECT_EQ(queue.dropped(), 2u);
}

TEST(PictureQueue, WhileItIsClosedNothingIsCopiedOrCounted) {
  PictureQueue queue(2, kWidth_px, kHeight_px);
  queue.set_open(false);
  EXPECT_FALSE(queue.push(Frame(1).view));
  EXPECT_EQ(queue.front().grey, nullptr);
  EXPECT_EQ(queue.dropped(), 0u);
  queue.set_open(true);
  EXPECT_TRUE(queue.push(Frame(2).view));
  EXPECT_EQ(queue.front().header.sequence, 2u);
}

TEST(PictureQueue, FramesAreWholeAndInOrderBetweenTwoThreads) {
  PictureQueue queue(3, kWidth_px, kHeight_px);
  constexpr std::uint64_t kFrames = 3000;
  std::jthread writer([&] {
    for (std::uint64_t sequence = 1; sequence <= kFrames; ++sequence)
      while (!queue.push(Frame(sequence).view)) std::this_thread::yield();
  });
  for (std::uint64_t expected = 1; expected <= kFrames;) {
    const FrameView frame = queue.front();
    if (frame.grey == nullptr) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_EQ(frame.header.sequence, expected);
    for (std::uint32_t i = 0; i < kWidth_px * kHeight_px; ++i)
      ASSERT_EQ(frame.grey[i], static_cast<std::uint8_t>(expected));
    queue.pop();
    ++expected;
  }
}

}  // namespace
}  // namespace heel
