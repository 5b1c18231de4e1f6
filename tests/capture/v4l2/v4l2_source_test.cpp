// Streaming from a scripted device: pixels, stamps, gaps, damaged frames, and every way to lose the device.
#include "capture/v4l2/v4l2_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "capture/v4l2/scripted_v4l2_device.h"
#include "capture/v4l2/v4l2_source_fixture.h"
#include "support/allocation_count.h"

namespace heel {
namespace {

using test::kHeight;
using test::kWidth;
using test::luma;
using test::ScriptedCamera;
using test::ScriptedFrame;
using test::ScriptedV4l2Device;
using test::V4l2SourceTest;
using testing::HasSubstr;

TEST_F(V4l2SourceTest, FramesOfEachUncompressedFormatAndStride) {
  for (const auto& [format, pixel_bytes] : {std::pair{V4L2_PIX_FMT_YUYV, 2u},
                                            {V4L2_PIX_FMT_GREY, 1u},
                                            {V4L2_PIX_FMT_NV12, 1u},
                                            {V4L2_PIX_FMT_RGB24, 3u},
                                            {V4L2_PIX_FMT_BGR24, 3u}}) {
    for (const std::uint32_t padding : {0u, 5u}) {
      camera_.formats = {static_cast<std::uint32_t>(format)};
      camera_.padding = padding;
      V4l2Source source = make();
      ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
      // More frames than there are buffers: each is given back.
      for (std::uint32_t sequence = 0; sequence < 10; ++sequence) {
        give(sequence, pixel_bytes);
        expect_frame(source, sequence);
      }
      EXPECT_EQ(source.wait_frame(0, frame_), FrameResult::Timeout);
      EXPECT_EQ(source.counters().dropped_by_driver, 0u);
    }
  }
}

TEST_F(V4l2SourceTest, OfFramesOfTwoFieldsTheSecondIsNotSeen) {
  camera_.formats = {V4L2_PIX_FMT_YUYV};
  camera_.field = V4L2_FIELD_INTERLACED;
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  EXPECT_THAT(source.description(), HasSubstr("interlaced: every second row is used"));
  ScriptedFrame frame = made(0, 2);
  for (std::uint32_t y = 1; y < kHeight; y += 2) {
    for (std::uint32_t x = 0; x < kWidth; ++x) frame.bytes[(y * kWidth + x) * 2] = 255;
  }
  camera_.frames.push_back(frame);
  ASSERT_EQ(source.wait_frame(0, frame_), FrameResult::Frame) << source.problem();
  for (std::uint32_t x = 0; x < kWidth; ++x) {
    EXPECT_EQ(frame_.grey[x], luma(x, 0, 0));
    EXPECT_EQ(frame_.grey[frame_.stride_bytes + x], luma(x, 1, 0)) << "the mean of its neighbours";
    EXPECT_EQ(frame_.grey[2 * frame_.stride_bytes + x], luma(x, 2, 0));
  }
}

TEST_F(V4l2SourceTest, MotionJpegIsDecodedAndDamagedImagesAreCountedAndSkipped) {
  camera_.formats = {V4L2_PIX_FMT_MJPEG};
  cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(77));
  ScriptedFrame good;
  cv::imencode(".jpg", image, good.bytes);
  ScriptedFrame damaged = good;
  damaged.bytes.resize(damaged.bytes.size() / 2);
  damaged.sequence = 1;
  ScriptedFrame last = good;
  last.sequence = 2;
  camera_.frames = {good, damaged, last};
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  ASSERT_EQ(source.wait_frame(0, frame_), FrameResult::Frame);
  EXPECT_NEAR(frame_.grey[0], 77, 1);
  EXPECT_EQ(source.wait_frame(0, frame_), FrameResult::Error);
  EXPECT_EQ(source.counters().corrupt, 1u);
  ASSERT_EQ(source.wait_frame(0, frame_), FrameResult::Frame) << "a damaged image must not end the stream";
  EXPECT_EQ(frame_.header.sequence, 3u);
}

TEST_F(V4l2SourceTest, GapsAndDamagedBuffersAreCounted) {
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened);
  for (const std::uint32_t sequence : {0xfffffffeu, 0xffffffffu, 2u}) give(sequence);  // 0 and 1 are missing
  expect_frame(source, 0xfffffffeu);
  const std::uint64_t first = frame_.header.sequence;
  expect_frame(source, 0xffffffffu);
  EXPECT_EQ(frame_.header.sequence, first + 1);
  expect_frame(source, 2u);
  EXPECT_EQ(frame_.header.sequence, first + 4) << "the count continues when the driver's counter wraps";
  EXPECT_EQ(source.counters().dropped_by_driver, 2u);

  give(3);
  camera_.frames.back().flags |= V4L2_BUF_FLAG_ERROR;
  EXPECT_EQ(source.wait_frame(0, frame_), FrameResult::Error);
  EXPECT_EQ(source.counters().dropped_by_driver, 3u);
  give(4);
  expect_frame(source, 4);
  EXPECT_EQ(source.counters().dropped_by_driver, 3u);
}

TEST_F(V4l2SourceTest, DriversThatDoNotCountMakeNoGaps) {
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened);
  for (const std::uint32_t sequence : {0u, 0u, 0u, 9u, 3u}) give(sequence);
  for (const std::uint32_t sequence : {0u, 0u, 0u}) expect_frame(source, sequence);
  EXPECT_EQ(frame_.header.sequence, 3u);
  EXPECT_EQ(source.counters().dropped_by_driver, 0u);
  expect_frame(source, 9u);
  EXPECT_EQ(source.counters().dropped_by_driver, 8u);
  expect_frame(source, 3u);
  EXPECT_EQ(source.counters().dropped_by_driver, 8u) << "a counter that goes backwards is not a gap";
}

TEST_F(V4l2SourceTest, ShortAndOverlongBuffersAreRefusedAndNotRead) {
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened);
  give(0);
  camera_.frames.back().bytes.resize(kWidth * 2 * kHeight - 1);
  EXPECT_EQ(source.wait_frame(0, frame_), FrameResult::Error);
  EXPECT_THAT(source.problem(), HasSubstr("v4l2:/dev/scripted: the frame is too short"));
  camera_.frames.push_back({.bytes = {}, .sequence = 1});
  EXPECT_EQ(source.wait_frame(0, frame_), FrameResult::Error);
  EXPECT_EQ(source.counters().corrupt, 2u);
  give(2);
  expect_frame(source, 2);
}

TEST_F(V4l2SourceTest, EveryErrorOfTheDeviceMeansLostAndItCanBeOpenedAgain) {
  V4l2Source source = make();
  int lives = 0;
  for (const int error : {EIO, ENODEV, EINVAL, EPIPE}) {
    ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
    ++lives;
    give(7);
    expect_frame(source, 7);
    camera_.frames.push_back({.error = error});
    EXPECT_EQ(source.wait_frame(0, frame_), FrameResult::Lost);
    EXPECT_THAT(source.problem(), HasSubstr(std::strerror(error)));
    source.close();
    EXPECT_EQ(source.wait_frame(0, frame_), FrameResult::Lost) << "closed";
  }
  EXPECT_EQ(camera_.opened, lives);
  EXPECT_EQ(camera_.mapped, 4 * lives);
  EXPECT_EQ(camera_.unmapped, camera_.mapped) << "no buffer stays mapped";
  EXPECT_EQ(source.counters().dropped_by_driver, 0u) << "a reopening is not a gap";

  ASSERT_EQ(source.open(), OpenResult::Opened);
  give(8);
  expect_frame(source, 8);
  camera_.errors = {{VIDIOC_QBUF, ENODEV}};  // the disconnected device takes no buffer back
  EXPECT_EQ(source.wait_frame(0, frame_), FrameResult::Lost);
}

TEST_F(V4l2SourceTest, AShortSilenceIsATimeoutAndALongOneMeansLost) {
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened);
  give(0);
  expect_frame(source, 0);
  const TimeNs opened_ns = monotonic_now_ns();
  FrameResult result = FrameResult::Timeout;
  while (result == FrameResult::Timeout && monotonic_now_ns() - opened_ns < 60 * kNsPerS) {
    result = source.wait_frame(kNsPerMs, frame_);
  }
  EXPECT_EQ(result, FrameResult::Lost);
  EXPECT_GE(monotonic_now_ns() - opened_ns, StallWatch::kBetweenFrames_ns);
  EXPECT_THAT(source.problem(), HasSubstr("no frame for 2 s"));
}

TEST_F(V4l2SourceTest, ACameraThatTakesLongToStartGivesItsFrames) {
  camera_.first_frame_after_ns = 2600 * kNsPerMs;
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened);
  give(0);
  FrameResult result = FrameResult::Timeout;
  while (result == FrameResult::Timeout) result = source.wait_frame(100 * kNsPerMs, frame_);
  EXPECT_EQ(result, FrameResult::Frame) << source.problem();
  EXPECT_EQ(camera_.opened, 1);
}

TEST_F(V4l2SourceTest, GivingUncompressedFramesDoesNotAllocate) {
  if (!test::counts_allocations()) GTEST_SKIP() << "a sanitizer owns the allocator";
  // The scripted device itself allocates for each frame; a device that gives the same frame each time does
  // not.
  class Tireless final : public V4l2Device {
   public:
    explicit Tireless(ScriptedCamera& camera) : scripted_(camera) {}
    int open(const std::string& path) override { return scripted_.open(path); }
    void close() override { scripted_.close(); }
    void* map(std::size_t bytes, std::int64_t offset) override { return scripted_.map(bytes, offset); }
    void unmap(void* memory, std::size_t bytes) override { scripted_.unmap(memory, bytes); }
    PollResult wait_readable(TimeNs) override { return PollResult::Ready; }
    int control(unsigned long request, void* argument) override {
      if (request == VIDIOC_QBUF) return 0;
      if (request != VIDIOC_DQBUF) return scripted_.control(request, argument);
      auto& buffer = *static_cast<v4l2_buffer*>(argument);
      buffer.bytesused = kWidth * 2 * kHeight;
      buffer.sequence = ++sequence_;
      if (sequence_ % 10 == 0) buffer.flags = V4L2_BUF_FLAG_ERROR;
      return 0;
    }

   private:
    ScriptedV4l2Device scripted_;
    std::uint32_t sequence_ = 0;
  };
  V4l2Source source("/dev/tireless", config_, std::make_unique<Tireless>(camera_));
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  const std::uint64_t before = test::allocations_of_this_thread();
  int good = 0;
  for (int i = 0; i < 1000; ++i) good += source.wait_frame(0, frame_) == FrameResult::Frame ? 1 : 0;
  EXPECT_EQ(test::allocations_of_this_thread() - before, 0u) << "damaged frames included";
  EXPECT_EQ(good, 900);
}

}  // namespace
}  // namespace heel
