// Streaming from a scripted device: pixels, stamps, gaps, damaged frames, and every way to lose the device.
#include "capture/v4l2/v4l2_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "capture/v4l2/device_users.h"
#include "capture/v4l2/scripted_v4l2_device.h"
#include "support/allocation_count.h"
#include "support/process.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::ScriptedCamera;
using test::ScriptedFrame;
using test::ScriptedV4l2Device;
using testing::HasSubstr;

constexpr std::uint32_t kWidth = 8;
constexpr std::uint32_t kHeight = 4;

std::uint8_t luma(std::uint32_t x, std::uint32_t y, std::uint32_t sequence) {
  return static_cast<std::uint8_t>(x * 5 + y * 41 + sequence * 3);
}

class V4l2SourceTest : public testing::Test {
 protected:
  V4l2SourceTest() {
    config_.width_px = kWidth;
    config_.height_px = kHeight;
  }

  V4l2Source make() { return {"/dev/scripted", config_, std::make_unique<ScriptedV4l2Device>(camera_)}; }

  void expect_frame(V4l2Source& source, std::uint32_t driver_sequence) {
    ASSERT_EQ(source.wait_frame(0, frame_), FrameResult::Frame) << source.problem();
    ASSERT_EQ(frame_.header.width_px, kWidth);
    ASSERT_EQ(frame_.header.height_px, kHeight);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        ASSERT_EQ(frame_.grey[y * frame_.stride_bytes + x], luma(x, y, driver_sequence)) << x << ',' << y;
      }
    }
  }

  // A grey frame in the camera's format (two bytes a pixel: YUYV, three: RGB), with the camera's row padding.
  ScriptedFrame made(std::uint32_t sequence, std::uint32_t pixel_bytes) const {
    const std::uint32_t stride = kWidth * pixel_bytes + camera_.padding;
    ScriptedFrame frame{.bytes = std::vector<std::uint8_t>(stride * kHeight, 0xee), .sequence = sequence};
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const auto pixel = frame.bytes.begin() + y * stride + x * pixel_bytes;
        std::fill_n(pixel, pixel_bytes == 3 ? 3 : 1, luma(x, y, sequence));
      }
    }
    return frame;
  }
  void give(std::uint32_t sequence, std::uint32_t pixel_bytes = 2) {
    camera_.frames.push_back(made(sequence, pixel_bytes));
  }

  ScriptedCamera camera_;
  CameraConfig config_;
  FrameView frame_;
};

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

v4l2_buffer stamped(std::uint32_t flags, TimeNs t_ns) {
  v4l2_buffer buffer{};
  buffer.flags = flags;
  buffer.timestamp = {t_ns / kNsPerS, t_ns % kNsPerS / kNsPerUs};
  return buffer;
}

TEST(V4l2CaptureTime, FollowsTheFlagsAndRefusesImplausibleStamps) {
  constexpr TimeNs kArrived = 100 * kNsPerS;
  constexpr TimeNs kStamp = kArrived - 30 * kNsPerMs;
  constexpr TimeNs kExposure = 8 * kNsPerMs;
  constexpr std::uint32_t kMonotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  constexpr std::uint32_t kStart = kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  EXPECT_EQ(capture_time_ns(stamped(kMonotonic, kStamp), 0, kArrived), kStamp);
  EXPECT_EQ(capture_time_ns(stamped(kStart, kStamp), kExposure, kArrived), kStamp + kExposure / 2);
  EXPECT_EQ(capture_time_ns(stamped(kMonotonic, kStamp), kExposure, kArrived), kStamp - kExposure / 2);
  EXPECT_EQ(capture_time_ns(stamped(V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN, kStamp), 0, kArrived), kArrived);
  EXPECT_EQ(capture_time_ns(stamped(V4L2_BUF_FLAG_TIMESTAMP_COPY, kStamp), 0, kArrived), kArrived);
  EXPECT_EQ(capture_time_ns(stamped(kMonotonic, kArrived + kNsPerMs), 0, kArrived), kArrived)
      << "in the future";
  EXPECT_EQ(capture_time_ns(stamped(kMonotonic, kArrived - 2 * kNsPerS), 0, kArrived), kArrived) << "stale";
}

TEST(V4l2CaptureTime, RefusesStampsNearTheOverflowOf64BitNanoseconds) {
  constexpr TimeNs kArrived = 100 * kNsPerS;
  // The last full second of 64-bit nanoseconds, the first negative ones after it, and seconds that do not
  // fit.
  for (const std::int64_t t_s :
       {std::int64_t{9223372036}, std::int64_t{-9223372037}, std::numeric_limits<std::int64_t>::min(),
        std::numeric_limits<std::int64_t>::max()}) {
    v4l2_buffer buffer = stamped(V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC, 0);
    buffer.timestamp.tv_sec = t_s;
    EXPECT_EQ(capture_time_ns(buffer, 0, kArrived), kArrived) << t_s;
  }
  for (const TimeNs t_ns : {std::numeric_limits<TimeNs>::min(), std::numeric_limits<TimeNs>::max()}) {
    EXPECT_FALSE(is_plausible_stamp(t_ns, kArrived)) << t_ns;
  }
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

TEST(StallWatch, GrowsWithEachOpeningThatGaveNoFrame) {
  StallWatch watch;
  for (const TimeNs allowed_s : {4, 8, 16, 16}) {
    watch.opened(0);
    EXPECT_FALSE(watch.stalled(allowed_s * kNsPerS));
    EXPECT_TRUE(watch.stalled(allowed_s * kNsPerS + 1));
  }
  watch.frame(100 * kNsPerS);
  EXPECT_TRUE(watch.stalled(102 * kNsPerS + 1));
  watch.opened(0);
  EXPECT_TRUE(watch.stalled(4 * kNsPerS + 1)) << "a frame has shown that the camera works";
}

TEST_F(V4l2SourceTest, FormatsWithoutUsbBandwidthAreLeftOut) {
  camera_.formats = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_MJPEG};
  camera_.without_bandwidth = {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_YUYV};
  V4l2Source source = make();
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  EXPECT_EQ(camera_.format, std::uint32_t{V4L2_PIX_FMT_MJPEG});
  EXPECT_THAT(source.description(), HasSubstr("MJPG 8x4"));

  camera_.without_bandwidth.insert(V4L2_PIX_FMT_MJPEG);
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), testing::AllOf(HasSubstr("too little USB bandwidth for 8x4"),
                                               HasSubstr("as GREY, YUYV, MJPG")));
  EXPECT_EQ(camera_.unmapped, camera_.mapped);

  config_.format = "YUYV";
  V4l2Source named = make();
  EXPECT_EQ(named.open(), OpenResult::Absent);
  EXPECT_THAT(named.problem(), HasSubstr("USB bandwidth"));
  EXPECT_EQ(camera_.format, std::uint32_t{V4L2_PIX_FMT_YUYV}) << "a named format is not replaced";
}

TEST_F(V4l2SourceTest, ThatAnotherProgramUsesTheCameraIsSaidWithItsName) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_text(folder.file("camera"), "");
  const test::Process other({"sleep", "600"});
  EXPECT_EQ(programs_holding(path), "");
  const test::Process holder({"/bin/sh", "-c", "exec 9<" + path + "; exec sleep 600"});
  EXPECT_TRUE(test::eventually([&] { return programs_holding(path).starts_with("sleep (process "); }));
  camera_.errors = {{VIDIOC_S_FMT, EBUSY}};
  V4l2Source source(path, config_, std::make_unique<ScriptedV4l2Device>(camera_));
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("; in use by sleep (process "));
}

TEST_F(V4l2SourceTest, OpeningGivesAbsentOrRefusedWithTheReason) {
  V4l2Source source = make();
  camera_.open_error = ENOENT;
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("v4l2:/dev/scripted: cannot be opened: No such file"));
  camera_.open_error = EACCES;
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("Permission denied (expected a user of the group video"));
  camera_.open_error = ENOTTY;
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("is not a device"));
  camera_.open_error = 0;
  camera_.errors = {{VIDIOC_REQBUFS, EBUSY}};
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("another program is using it"));
  camera_.errors = {{VIDIOC_STREAMON, EINVAL}};
  EXPECT_EQ(source.open(), OpenResult::Absent);
  EXPECT_THAT(source.problem(), HasSubstr("does not start streaming"));
  camera_.errors.clear();
  camera_.most_buffers = 1;
  EXPECT_EQ(source.open(), OpenResult::Refused);
  EXPECT_THAT(source.problem(), HasSubstr("gives 1 buffer(s)"));
  camera_.most_buffers = 3;
  config_.rate_hz = 30.0;
  EXPECT_EQ(source.open(), OpenResult::Opened);
  EXPECT_THAT(source.description(), HasSubstr("Scripted camera, YUYV 8x4 at 30 Hz"));
  EXPECT_EQ(camera_.unmapped, camera_.mapped - 3);
}

TEST_F(V4l2SourceTest, AFileThatIsNotADeviceIsRefused) {
  V4l2Source file("/etc/hostname", config_);
  EXPECT_EQ(file.open(), OpenResult::Refused);
  EXPECT_THAT(file.problem(), HasSubstr("is not a device"));
  V4l2Source null("/dev/null", config_);
  EXPECT_EQ(null.open(), OpenResult::Refused);
  EXPECT_THAT(null.problem(), HasSubstr("is not a V4L2 device"));
  V4l2Source missing("/dev/heel-no-such-camera", config_);
  EXPECT_EQ(missing.open(), OpenResult::Absent);
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
