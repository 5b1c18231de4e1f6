// Files as cameras: order, pace, stamps, end, and the messages for bad ones.
#include "capture/file/file_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "realtime/clock.h"
#include "support/made_video.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FileSourceTest : public testing::Test {
 protected:
  std::string image(const std::string& name, int grey, int width_px = 32, int height_px = 16) {
    const std::string path = folder_ / name;
    cv::imwrite(path, cv::Mat(height_px, width_px, CV_8UC1, cv::Scalar(grey)));
    return path;
  }

  std::string video(int frames, double rate_hz) {
    const std::string path = folder_ / "video.avi";
    cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), rate_hz,
                           cv::Size(64, 48));
    for (int i = 0; i < frames; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(20 + 10 * i)));
    return path;
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(FileSourceTest, AFolderIsReadInNaturalOrderWithTheFilesOwnTimesAtSpeed0) {
  for (const int number : {10, 1, 9, 2}) image("frame" + std::to_string(number) + ".png", number * 10);
  std::ofstream(folder_ / "notes.txt") << "not an image";
  FileSource source(folder_, 10.0, 0.0);
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  FrameView frame;
  std::uint64_t index = 0;
  for (const int grey : {10, 20, 90, 100}) {
    ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
    EXPECT_EQ(frame.grey[0], grey);
    EXPECT_EQ(frame.grey[15 * frame.stride_bytes + 31], grey);
    EXPECT_EQ(frame.header.width_px, 32u);
    EXPECT_EQ(frame.header.height_px, 16u);
    EXPECT_EQ(frame.header.sequence, index);
    EXPECT_EQ(frame.header.t_capture_ns, static_cast<TimeNs>(index) * 100 * kNsPerMs);
    ++index;
  }
  EXPECT_EQ(source.wait_frame(0, frame), FrameResult::EndOfStream);
  EXPECT_EQ(source.wait_frame(0, frame), FrameResult::EndOfStream) << "it stays at the end";
  EXPECT_THAT(source.problem(), HasSubstr("ended after 4 images"));
  ASSERT_EQ(source.open(), OpenResult::Opened) << "opened again, it starts from the beginning";
  ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(frame.grey[0], 10);
}

TEST_F(FileSourceTest, OneImageIsOneFrame) {
  FileSource source(image("one.PNG", 77), 30.0, 1.0);
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  FrameView frame;
  ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(frame.grey[0], 77);
  EXPECT_EQ(source.wait_frame(kNsPerS, frame), FrameResult::EndOfStream);
}

TEST_F(FileSourceTest, TheLastFrameLastsAPeriodSoThatALoopKeepsItsPace) {
  FileSource source(image("one.png", 77), 5.0, 2.0);
  FrameView frame;
  TimeNs last_ns = 0;
  for (int round = 0; round < 3; ++round) {
    ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
    ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
    if (round > 0) {
      EXPECT_GE(frame.header.t_capture_ns - last_ns, 100 * kNsPerMs) << "5 Hz, twice as fast";
    }
    last_ns = frame.header.t_capture_ns;
    FrameResult result = source.wait_frame(kNsPerMs, frame);
    EXPECT_EQ(result, FrameResult::Timeout) << "not yet";
    while (result == FrameResult::Timeout) result = source.wait_frame(kNsPerMs, frame);
    EXPECT_EQ(result, FrameResult::EndOfStream);
  }
}

TEST_F(FileSourceTest, AVideosOwnRateTimesTheSpeed) {
  FileSource source(video(6, 25.0), 1.0, 2.0);
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  EXPECT_DOUBLE_EQ(source.rate_hz(), 25.0);
  FrameView frame;
  ASSERT_EQ(source.wait_frame(60 * kNsPerS, frame), FrameResult::Frame);
  TimeNs last_ns = frame.header.t_capture_ns;
  EXPECT_LE(last_ns, monotonic_now_ns());
  for (int i = 1; i < 6; ++i) {
    ASSERT_EQ(source.wait_frame(60 * kNsPerS, frame), FrameResult::Frame) << i;
    EXPECT_NEAR(frame.grey[0], 20 + 10 * i, 3) << "MJPEG is not exact";
    EXPECT_GE(monotonic_now_ns(), frame.header.t_capture_ns) << "no frame is given before it is due";
    // 20 ms apart at twice 25 Hz; a busy machine can only make it later.
    EXPECT_GE(frame.header.t_capture_ns - last_ns, 20 * kNsPerMs - 1);
    last_ns = frame.header.t_capture_ns;
  }
  EXPECT_EQ(source.wait_frame(60 * kNsPerS, frame), FrameResult::EndOfStream);
}

TEST_F(FileSourceTest, AVideoOfAVariableRateKeepsItsOwnTimes) {
  const std::string path = folder_ / "varied.mp4";
  test::MadeVideo made{
      .path = path, .greys = {}, .times_s = {0.0, 0.01, 0.02, 0.1, 0.18, 0.2}, .display_abcd = {}};
  for (std::size_t i = 0; i < made.times_s.size(); ++i)
    made.greys.emplace_back(48, 64, CV_8U, cv::Scalar(20));
  test::write_video(made);
  FileSource at_once(path, 1.0, 0.0);
  ASSERT_EQ(at_once.open(), OpenResult::Opened) << at_once.problem();
  FrameView frame;
  for (const double t_s : made.times_s) {
    ASSERT_EQ(at_once.wait_frame(0, frame), FrameResult::Frame);
    EXPECT_NEAR(static_cast<double>(frame.header.t_capture_ns) * 1e-9, t_s, 1e-6);
  }
  FileSource paced(path, 1.0, 2.0);
  ASSERT_EQ(paced.open(), OpenResult::Opened) << paced.problem();
  TimeNs last_ns = 0;
  for (std::size_t i = 0; i < made.times_s.size(); ++i) {
    ASSERT_EQ(paced.wait_frame(60 * kNsPerS, frame), FrameResult::Frame);
    // A busy machine can only make it later.
    const TimeNs least_ns = i > 0 ? ns_from_seconds((made.times_s[i] - made.times_s[i - 1]) / 2.0) - 1000 : 0;
    EXPECT_GE(frame.header.t_capture_ns - last_ns, least_ns) << i;
    last_ns = frame.header.t_capture_ns;
  }
}

TEST_F(FileSourceTest, ACutVideoEndsWithHowMuchOfItThereWas) {
  const std::string path = folder_ / "cut.mkv";
  test::MadeVideo made{.path = path, .greys = {}, .times_s = {}, .display_abcd = {}};
  for (int i = 0; i < 20; ++i) {
    made.greys.emplace_back(48, 64, CV_8U);
    cv::randu(made.greys.back(), 0, 255);
    made.times_s.push_back(0.04 * i);
  }
  test::write_video(made);
  test::cut_file(path, 0.5);
  FileSource source(path, 1.0, 0.0);
  ASSERT_EQ(source.open(), OpenResult::Opened) << source.problem();
  FrameView frame;
  int frames = 0;
  while (source.wait_frame(0, frame) == FrameResult::Frame) ++frames;
  EXPECT_GT(frames, 0);
  EXPECT_THAT(source.problem(), HasSubstr("ends after " + std::to_string(frames) + " of 20 frames"));
}

TEST_F(FileSourceTest, TimesOutWhileAFrameIsNotDueYetAndGivesItLater) {
  image("a.png", 1);
  image("b.png", 2);
  FileSource source(folder_, 1.0,
                    1.0);  // one second, so that also a busy machine asks before the frame is due
  ASSERT_EQ(source.open(), OpenResult::Opened);
  FrameView frame;
  ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(source.wait_frame(kNsPerMs, frame), FrameResult::Timeout);
  ASSERT_EQ(source.wait_frame(60 * kNsPerS, frame), FrameResult::Frame);
  EXPECT_EQ(frame.grey[0], 2);
}

TEST_F(FileSourceTest, ASlowReaderGetsEveryFrameWithFreshStampsAndNoBurst) {
  for (int i = 0; i < 3; ++i) image(std::to_string(i) + ".png", i);
  FileSource source(folder_, 200.0, 1.0);
  ASSERT_EQ(source.open(), OpenResult::Opened);
  FrameView frame;
  ASSERT_EQ(source.wait_frame(60 * kNsPerS, frame), FrameResult::Frame);
  sleep_until_ns(monotonic_now_ns() + 50 * kNsPerMs);  // ten periods
  const TimeNs back_ns = monotonic_now_ns();
  ASSERT_EQ(source.wait_frame(60 * kNsPerS, frame), FrameResult::Frame);
  EXPECT_EQ(frame.header.sequence, 1u);
  EXPECT_GE(frame.header.t_capture_ns, back_ns) << "a camera's stamps would be as new";
  const TimeNs second_ns = frame.header.t_capture_ns;
  ASSERT_EQ(source.wait_frame(60 * kNsPerS, frame), FrameResult::Frame);
  EXPECT_GE(frame.header.t_capture_ns - second_ns, 5 * kNsPerMs - 1);
}

TEST_F(FileSourceTest, AnImageThatCannotBeDecodedIsCountedAndSkipped) {
  image("1.png", 1);
  std::ofstream(folder_ / "2.png") << "no image at all";
  image("3.png", 3);
  FileSource source(folder_, 30.0, 0.0);
  ASSERT_EQ(source.open(), OpenResult::Opened);
  FrameView frame;
  EXPECT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(source.wait_frame(0, frame), FrameResult::Error);
  EXPECT_THAT(source.problem(), HasSubstr("2.png"));
  EXPECT_EQ(source.counters().corrupt, 1u);
  ASSERT_EQ(source.wait_frame(0, frame), FrameResult::Frame);
  EXPECT_EQ(frame.grey[0], 3);
  EXPECT_EQ(frame.header.sequence, 2u);
}

TEST_F(FileSourceTest, OtherFilesAndEmptyFoldersAreRefusedByName) {
  FileSource missing(folder_ / "missing.mp4", 30.0, 0.0);
  EXPECT_EQ(missing.open(), OpenResult::Refused);
  EXPECT_THAT(missing.problem(), HasSubstr("missing.mp4: no such file"));

  FileSource empty(folder_, 30.0, 0.0);
  EXPECT_EQ(empty.open(), OpenResult::Refused);
  EXPECT_THAT(empty.problem(), HasSubstr("holds no images"));

  std::ofstream(folder_ / "text.mp4") << "not a video";
  FileSource text(folder_ / "text.mp4", 30.0, 0.0);
  EXPECT_EQ(text.open(), OpenResult::Refused);
  EXPECT_THAT(text.problem(), HasSubstr("cannot be decoded"));
  FrameView frame;
  EXPECT_EQ(text.wait_frame(0, frame), FrameResult::Lost);
}

}  // namespace
}  // namespace heel
