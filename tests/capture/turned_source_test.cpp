// A turned camera: its frames, and that the capture thread does not allocate for them.
#include "capture/turned/turned_source.h"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <vector>

#include "support/allocation_count.h"

namespace heel {
namespace {

constexpr std::uint32_t kTurnedWidth_px = 640, kTurnedHeight_px = 480;

/// Frames of one size, whose pixels count up.
class CountingSource : public FrameSource {
 public:
  CountingSource(std::uint32_t width_px, std::uint32_t height_px)
      : FrameSource("counting:"),
        width_px_(width_px),
        height_px_(height_px),
        grey_(std::size_t{width_px} * height_px) {
    std::iota(grey_.begin(), grey_.end(), std::uint8_t{1});
  }
  OpenResult open() override {
    description_ = "counting";
    return OpenResult::Opened;
  }
  FrameResult wait_frame(TimeNs, FrameView& frame) override {
    frame = {{0, 0, width_px_, height_px_}, grey_.data(), width_px_};
    return FrameResult::Frame;
  }
  void close() override {}

 private:
  std::uint32_t width_px_, height_px_;
  std::vector<std::uint8_t> grey_;
};

std::unique_ptr<TurnedSource> turned_source(std::uint32_t width_px, std::uint32_t height_px) {
  auto source = std::make_unique<TurnedSource>(std::make_unique<CountingSource>(width_px, height_px),
                                               picture_turn(90, false), kTurnedWidth_px, kTurnedHeight_px);
  EXPECT_EQ(source->open(), OpenResult::Opened);
  EXPECT_EQ(source->description(), "counting, turned by 90°");
  return source;
}

TEST(TurnedSource, DoesNotAllocateForTheFirstFrameOfTheSizeThatIsAskedFor) {
  for (const std::uint32_t height_px : {kTurnedHeight_px, kTurnedHeight_px / 2}) {
    const auto source = turned_source(kTurnedWidth_px, height_px);
    FrameView frame;
    const std::uint64_t before = test::allocations_of_this_thread();
    EXPECT_EQ(source->wait_frame(0, frame), FrameResult::Frame);
    if (test::counts_allocations()) {
      EXPECT_EQ(test::allocations_of_this_thread() - before, 0U);
    }
    EXPECT_EQ(frame.header.width_px, height_px);
    EXPECT_EQ(frame.header.height_px, kTurnedWidth_px);
    EXPECT_EQ(frame.grey[height_px - 1], 1) << "the upper left pixel is at the right";
  }
}

TEST(TurnedSource, TakesALargerFrame) {
  const auto source = turned_source(kTurnedWidth_px, 2 * kTurnedHeight_px);
  FrameView frame;
  ASSERT_EQ(source->wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(frame.header.width_px, 2 * kTurnedHeight_px);
  EXPECT_EQ(frame.grey[2 * kTurnedHeight_px - 1], 1);
}

}  // namespace
}  // namespace heel
