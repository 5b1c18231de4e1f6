// Videos whose packets are no frames as they are: fields of a frame, and zeros where frames were to be.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <string>

#include "files/video_reader.h"
#include "support/made_video.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::MadeVideo;
using test::write_video;

constexpr int kWide_px = 64, kHigh_px = 48;

class VideoPackets : public ::testing::Test {
 protected:
  MadeVideo walk(const std::string& name, int frames) {
    MadeVideo video{.path = folder.file(name), .greys = {}, .times_s = {}, .display_abcd = {}};
    for (int i = 0; i < frames; ++i) {
      video.greys.emplace_back(kHigh_px, kWide_px, CV_8U, cv::Scalar(40 + 2 * i));
      video.times_s.push_back(i * 0.05);
    }
    return video;
  }
  std::size_t frames_of(const std::string& path) {
    EXPECT_TRUE(reader.open(path)) << reader.problem();
    std::size_t frames = 0;
    for (cv::Mat grey; reader.read(grey);) ++frames;
    return frames;
  }

  test::TemporaryFolder folder;
  VideoReader reader;
};

/// As capture cards write them: each field is a picture of half the rows.
TEST_F(VideoPackets, OfTwoJpegFieldsInAPacketGiveTheFirstOne) {
  MadeVideo video = walk("card.avi", 3);
  video.ticks_per_s = 20;
  video.jpeg = video.jpeg_fields = true;
  for (cv::Mat& grey : video.greys) {
    for (int y = 0; y < grey.rows; ++y) grey.row(y).setTo(y % 2 == 0 ? 50 + 3 * y : 250);
  }
  write_video(video);
  EXPECT_EQ(frames_of(video.path), 3u);
  EXPECT_EQ(reader.missing(), "");
  ASSERT_TRUE(reader.open(video.path));
  cv::Mat grey;
  ASSERT_TRUE(reader.read(grey));
  ASSERT_EQ(grey.size(), cv::Size(kWide_px, kHigh_px));
  for (int y = 0; y < kHigh_px - 1; ++y) EXPECT_NEAR(grey.at<std::uint8_t>(y, 8), 50 + 3 * y, 4) << y;
  EXPECT_EQ(reader.note(), "interlaced: every second row is used");
}

/// Where a copy or a recording was interrupted, the file may have its whole length, and zeros at its end.
TEST_F(VideoPackets, WithZerosAtTheirEndSayWhatThereWas) {
  for (const bool jpeg : {false, true}) {
    MadeVideo video = walk("zeros.mp4", 40);
    for (cv::Mat& grey : video.greys) cv::randu(grey, 0, 255);
    video.index_first = true;
    video.jpeg = jpeg;
    write_video(video);
    std::string bytes = test::read_text(video.path);
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() * 2 / 3), bytes.end(), '\0');
    test::write_text(video.path, bytes);
    const std::size_t frames = frames_of(video.path);
    EXPECT_GT(frames, 20u);
    EXPECT_LT(frames, 30u);
    EXPECT_EQ(reader.missing(), "ends after " + std::to_string(frames) +
                                    " of 40 frames: the rest is zeros, as of a copy that was interrupted");
  }
}

}  // namespace
}  // namespace heel
