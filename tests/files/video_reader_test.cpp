// Videos: their own time stamps to the last frame, the picture as it is shown, and what is missing of a cut
// one.
#include "files/video_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "files/image_file.h"
#include "support/made_video.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace heel {
namespace {

using test::MadeVideo;
using test::write_video;
using ::testing::HasSubstr;

constexpr int kVideoWidth_px = 64, kVideoHeight_px = 48;

/// Of frame `index`: its upper left quarter is brighter than the rest.
cv::Mat made_frame(int index) {
  cv::Mat grey(kVideoHeight_px, kVideoWidth_px, CV_8U, cv::Scalar(40 + 2 * index));
  grey(cv::Rect(0, 0, kVideoWidth_px / 2, kVideoHeight_px / 2)).setTo(200);
  return grey;
}

/// A Matroska file whose Segment has a size of such bytes in place of its own: '\xff' is unknown.
std::string with_segment_size(std::string bytes, char size) {
  const std::size_t at = bytes.find("\x18\x53\x80\x67\x01");
  EXPECT_NE(at, std::string::npos);
  return bytes.replace(at + 5, 7, 7, size);
}

/// A Matroska file as a WebM one, when its name ends so.
std::string as_webm(std::string bytes, const std::string& name) {
  const std::size_t at = bytes.find("\x42\x82\x88matroska");
  EXPECT_NE(at, std::string::npos);
  // The rest of the longer name becomes a Void element.
  if (name.ends_with(".webm")) bytes.replace(at, 11, "\x42\x82\x84webm\xec\x82  ");
  return bytes;
}

/// A Y4M file of so many frames, cut by so many bytes.
void write_y4m(const std::string& path, int frames, std::size_t cut) {
  std::string bytes = "YUV4MPEG2 W64 H48 F20:1 Ip A1:1 C420jpeg\n";
  for (int i = 0; i < frames; ++i) {
    const cv::Mat grey = made_frame(i);
    bytes += "FRAME\n" + std::string(reinterpret_cast<const char*>(grey.data), grey.total()) +
             std::string(grey.total() / 2, '\x80');
  }
  bytes.resize(bytes.size() - cut);
  test::write_text(path, bytes);
}

class Videos : public ::testing::Test {
 protected:
  MadeVideo walk(const std::string& name, int frames, double period_s = 0.05) {
    MadeVideo video{.path = folder.file(name), .greys = {}, .times_s = {}, .display_abcd = {}};
    for (int i = 0; i < frames; ++i) {
      video.greys.push_back(made_frame(i));
      video.times_s.push_back(i * period_s);
    }
    return video;
  }
  std::vector<double> times_of(const std::string& path) {
    EXPECT_TRUE(reader.open(path)) << reader.problem();
    std::vector<double> times_s;
    for (cv::Mat grey; reader.read(grey);) times_s.push_back(reader.time_s());
    return times_s;
  }

  test::TemporaryFolder folder;
  VideoReader reader;
};

TEST_F(Videos, HaveTheirOwnTimeStampsToTheLastFrameAlsoWithBFrames) {
  for (const char* name : {"walk.mp4", "walk.mkv"}) {
    for (const int b_frames : {0, 2}) {
      MadeVideo video = walk(name, 31);
      video.b_frames = b_frames;
      write_video(video);
      const std::vector<double> times_s = times_of(video.path);
      ASSERT_EQ(times_s.size(), 31u) << name << " " << b_frames;
      for (std::size_t i = 0; i < times_s.size(); ++i)
        EXPECT_NEAR(times_s[i], 0.05 * static_cast<double>(i), 1.1e-3);
      EXPECT_EQ(reader.missing(), "");
      EXPECT_NEAR(reader.rate_hz(), 20.0, 0.1);
    }
  }
}

TEST_F(Videos, OfAVariableRateHaveTheirOwnTimeStamps) {
  for (const char* name : {"slower.mp4", "slower.mkv"}) {
    MadeVideo video = walk(name, 20);
    for (int i = 20; i < 40; ++i) {
      video.greys.push_back(made_frame(i));
      video.times_s.push_back(0.95 + 0.2 * (i - 19));
    }
    write_video(video);
    const std::vector<double> times_s = times_of(video.path);
    ASSERT_EQ(times_s.size(), 40u) << name;
    EXPECT_NEAR(times_s[19], 0.95, 1.1e-3) << name;
    EXPECT_NEAR(times_s[39], 4.95, 1.1e-3) << name;
    EXPECT_EQ(reader.missing(), "") << name;
  }
}

TEST_F(Videos, SkippedFramesCountAndHaveTimes) {
  const MadeVideo video = walk("walk.mp4", 5);
  write_video(video);
  ASSERT_TRUE(reader.open(video.path));
  EXPECT_EQ(reader.frame_count(), 5u);
  EXPECT_EQ(reader.size_px(), cv::Size(kVideoWidth_px, kVideoHeight_px));
  EXPECT_TRUE(reader.skip());
  EXPECT_TRUE(reader.skip());
  EXPECT_NEAR(reader.time_s(), 0.05, 1.1e-3);
  EXPECT_TRUE(reader.open(video.path)) << "again, from the beginning";
  EXPECT_TRUE(reader.skip());
  EXPECT_EQ(reader.time_s(), 0.0);
}

struct Turn {
  std::vector<double> abcd;
  int bright_x, bright_y;  ///< the quarter that is bright: 0 left or upper, 1 right or lower
  bool on_its_side;
};

TEST_F(Videos, AreTurnedAndMirroredAsTheirDisplayMatrixSays) {
  const std::vector<Turn> turns{{{1, 0, 0, 1}, 0, 0, false},  {{-1, 0, 0, -1}, 1, 1, false},
                                {{0, 1, -1, 0}, 1, 0, true},  {{0, -1, 1, 0}, 0, 1, true},
                                {{-1, 0, 0, 1}, 1, 0, false}, {{1, 0, 0, -1}, 0, 1, false},
                                {{0, 1, 1, 0}, 0, 0, true},   {{0, -1, -1, 0}, 1, 1, true}};
  for (const Turn& turn : turns) {
    SCOPED_TRACE(::testing::PrintToString(turn.abcd));
    MadeVideo video = walk("turned.mp4", 2);
    video.display_abcd = turn.abcd;
    write_video(video);
    ASSERT_TRUE(reader.open(video.path));
    cv::Mat grey;
    ASSERT_TRUE(reader.read(grey));
    EXPECT_EQ(grey.cols, turn.on_its_side ? kVideoHeight_px : kVideoWidth_px);
    EXPECT_EQ(reader.size_px(), grey.size());
    for (int y : {0, 1})
      for (int x : {0, 1})
        EXPECT_EQ(grey.at<std::uint8_t>((1 + 2 * y) * grey.rows / 4, (1 + 2 * x) * grey.cols / 4) > 120,
                  x == turn.bright_x && y == turn.bright_y);
  }
}

TEST_F(Videos, TurnedByAnotherAngleAreRefused) {
  MadeVideo video = walk("tilted.mp4", 2);
  video.display_abcd = {0.7071, 0.7071, -0.7071, 0.7071};
  write_video(video);
  EXPECT_FALSE(reader.open(video.path));
  EXPECT_THAT(reader.problem(), HasSubstr("multiple of 90 degrees"));
}

TEST_F(Videos, OfAPixelFormatThatCannotBeConvertedAreRefused) {
  for (const std::string format : {"rgb4", "bgr4", "rgb24"}) {
    MadeVideo video = walk("raw.nut", 2);
    video.raw_format = format.c_str();
    write_video(video);
    if (format == "rgb24") {
      EXPECT_EQ(times_of(video.path).size(), 2u) << "not every raw video is refused";
      continue;
    }
    EXPECT_FALSE(reader.open(video.path));
    EXPECT_EQ(reader.problem(), "pixel format " + format + ", which heel cannot convert");
    EXPECT_FALSE(reader.is_open());
  }
}

TEST_F(Videos, CutShortGiveWhatThereIsAndSayWhatIsMissing) {
  for (const char* name : {"cut.mp4", "cut.mkv", "cut.avi"}) {
    MadeVideo video = walk(name, 40);
    for (cv::Mat& grey : video.greys) cv::randu(grey, 0, 255);  // so that the frames are most of the file
    video.index_first = true;
    if (std::string(name).ends_with(".avi")) video.ticks_per_s = 20;
    for (const double share : {0.4, 0.6, 0.8}) {
      SCOPED_TRACE(std::string(name) + " " + std::to_string(share));
      write_video(video);
      test::cut_file(video.path, share);
      const std::size_t frames = times_of(video.path).size();
      EXPECT_GT(frames, 0u);
      EXPECT_LT(frames, 40u);
      EXPECT_EQ(reader.missing(), "ends after " + std::to_string(frames) + " of 40 frames");
    }
  }
}

TEST_F(Videos, WhoseLastFrameIsShownLongAreWhole) {
  for (const char* name : {"held.mp4", "held.mov"}) {
    MadeVideo video = walk(name, 10);
    video.last_shown_s = 3.0;
    write_video(video);
    EXPECT_EQ(times_of(video.path).size(), 10u) << name;
    EXPECT_EQ(reader.missing(), "") << name;
  }
}

TEST_F(Videos, InMatroskaAreCutWhereTheFileIsShorterThanItStates) {
  for (const char* name : {"walk.mkv", "walk.webm"}) {
    SCOPED_TRACE(name);
    MadeVideo video = walk(name, 10);
    for (cv::Mat& grey : video.greys) cv::randu(grey, 0, 255);
    video.path = folder.file("made.mkv");
    video.last_shown_s = 3.0;
    write_video(video);
    const std::string whole = as_webm(test::read_text(video.path), name);
    EXPECT_EQ(times_of(test::write_text(folder.file(name), whole)).size(), 10u);
    EXPECT_EQ(reader.missing(), "");
    const std::string void_element("\xec\x84lost", 6);
    EXPECT_EQ(times_of(test::write_text(folder.file(name), whole + void_element)).size(), 10u);
    EXPECT_EQ(reader.missing(), "") << "after the Segment";
    for (std::size_t place = 1; place <= 20; ++place) {
      const std::size_t bytes = place < 20 ? whole.size() * place / 20 : whole.size() - 1;
      SCOPED_TRACE(bytes);
      test::write_text(folder.file(name), whole.substr(0, bytes));
      ASSERT_TRUE(reader.open(folder.file(name))) << reader.problem();
      while (reader.skip()) {
      }
      EXPECT_THAT(reader.missing(), HasSubstr("ends after"));
    }
    for (const std::size_t unknown : {0u, 1u}) {
      test::write_text(folder.file(name), with_segment_size(whole, unknown == 0 ? '\0' : '\xff'));
      EXPECT_EQ(times_of(folder.file(name)).size(), 10u);
      EXPECT_THAT(reader.missing(), HasSubstr("ends after 10 of")) << "by the time that it states";
    }
  }
}

TEST_F(Videos, InMatroskaWithoutASizeAreJudgedByTheirTimes) {
  const MadeVideo video = walk("live.mkv", 10);
  write_video(video);
  const std::string live = with_segment_size(test::read_text(video.path), '\xff');
  EXPECT_EQ(times_of(test::write_text(video.path, live)).size(), 10u);
  EXPECT_EQ(reader.missing(), "");
}

TEST_F(Videos, OfInterlacedFramesGiveOneField) {
  MadeVideo video = walk("fields.mkv", 2);
  // The upper field of each frame is bright on the left, the lower one on the right.
  for (cv::Mat& grey : video.greys) {
    grey.setTo(60);
    for (int y = 0; y < grey.rows; ++y) grey.row(y).colRange(y % 2 * 32, y % 2 * 32 + 32) = 200;
  }
  for (const bool jpeg : {false, true}) {
    for (const char* says : {"nothing", "frames", "header"}) {
      SCOPED_TRACE(std::string(says) + (jpeg ? ", Motion-JPEG" : ""));
      if (jpeg && says == std::string("frames")) continue;
      video.jpeg = jpeg;
      video.interlaced = says == std::string("frames");
      video.header_interlaced = says == std::string("header");
      const bool interlaced = video.interlaced || video.header_interlaced;
      write_video(video);
      ASSERT_TRUE(reader.open(video.path));
      cv::Mat grey;
      ASSERT_TRUE(reader.read(grey));
      for (int y = 4; y < kVideoHeight_px - 4; ++y) {
        const bool lower_shown = !interlaced && y % 2 == 1;
        EXPECT_NEAR(grey.at<std::uint8_t>(y, 8), lower_shown ? 60 : 200, 30) << y;
        EXPECT_NEAR(grey.at<std::uint8_t>(y, kVideoWidth_px - 8), lower_shown ? 200 : 60, 30) << y;
      }
      EXPECT_EQ(reader.note(), interlaced ? "interlaced: every second row is used" : "");
    }
  }
}

TEST_F(Videos, DamagedMotionJpegFramesAreLeftOutAndCounted) {
  const std::string path = folder.file("damaged.avi");
  cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 20.0,
                         cv::Size(64, 48));
  cv::Mat noise(48, 64, CV_8UC3);
  for (int i = 0; i < 6; ++i) {
    cv::randu(noise, 0, 255);
    writer.write(noise);
  }
  writer.release();
  EXPECT_EQ(times_of(path).size(), 6u);
  EXPECT_EQ(reader.missing(), "");
  std::string bytes = test::read_text(path);
  std::size_t third = 0;
  for (int i = 0; i < 3; ++i) third = bytes.find("\xff\xd8\xff", third + 1);
  bytes.replace(third + 900, 2, "\xff\xd9");  // the frame ends in its middle
  const std::vector<double> times_s = times_of(test::write_text(path, bytes));
  ASSERT_EQ(times_s.size(), 5u);
  EXPECT_NEAR(times_s[2], 0.15, 1e-6) << "the others keep their times";
  EXPECT_EQ(reader.missing(), "1 of 6 frames are damaged and left out");
}

TEST_F(Videos, WithoutTheirIndexAreSaidToBeCut) {
  const MadeVideo video = walk("no_index.mp4", 10);
  write_video(video);
  test::cut_file(video.path, 0.7);
  EXPECT_FALSE(reader.open(video.path));
  EXPECT_THAT(reader.problem(), HasSubstr("cut short"));
}

TEST_F(Videos, AreNothingElse) {
  for (const auto& [name, text] :
       {std::pair{"words.txt", "no video\n"}, std::pair{"list.m3u8", "#EXTM3U\n#EXTINF:1,\nwalk.mp4\n"},
        std::pair{"list.ffconcat", "ffconcat version 1.0\nfile walk.mp4\n"}}) {
    write_video(walk("walk.mp4", 2));
    EXPECT_FALSE(reader.open(test::write_text(folder.file(name), text))) << name;
    EXPECT_NE(reader.problem(), "") << name;
  }
  EXPECT_FALSE(reader.is_open());
  EXPECT_FALSE(reader.open(folder.file("%d.png")));
}

TEST_F(Videos, OfPublicReportsAreRight) {
  HEEL_NEEDS_TEST_DATA("reports");
  const std::string reports = test::data_path("reports/");
  const std::vector<double> walk_s = times_of(reports + "video-last-frames-at-zero/walk.mp4");
  ASSERT_EQ(walk_s.size(), 40u);
  EXPECT_NEAR(walk_s[38], 1.90, 1e-6);
  EXPECT_NEAR(walk_s[39], 1.95, 1e-6);
  EXPECT_EQ(reader.missing(), "");
  const std::vector<double> varied_s = times_of(reports + "video-variable-rate-in-heeld/vfr.mp4");
  ASSERT_EQ(varied_s.size(), 40u);
  EXPECT_NEAR(varied_s[19], 0.95, 1e-6);
  EXPECT_NEAR(varied_s[39], 4.75, 1e-6);
  EXPECT_EQ(reader.missing(), "");
  cv::Mat grey;
  ASSERT_TRUE(reader.open(reports + "video-rotated/rot90.mp4"));
  ASSERT_TRUE(reader.read(grey));
  const cv::Mat shown = read_grey_image(reports + "video-rotated/shown.png").grey;
  EXPECT_LT(cv::norm(grey, shown, cv::NORM_INF), 2.0);
  cv::Mat turned;
  cv::rotate(shown, turned, cv::ROTATE_90_COUNTERCLOCKWISE);  // both videos have the same frames as stored
  ASSERT_TRUE(reader.open(reports + "video-rotated/rot180.mp4"));
  ASSERT_TRUE(reader.read(grey));
  ASSERT_EQ(grey.size(), turned.size());
  EXPECT_LT(cv::norm(grey, turned, cv::NORM_INF), 2.0);
  EXPECT_EQ(times_of(reports + "video-cut-short/cuttail.mkv").size(), 20u);
  EXPECT_EQ(reader.missing(), "ends after 20 of 40 frames");
}

TEST_F(Videos, ARawVideoThatEndsInsideAFrameIsCut) {
  for (const std::size_t cut : {std::size_t{0}, std::size_t{1}, std::size_t{2000}, std::size_t{4610}}) {
    SCOPED_TRACE(cut);
    const std::string path = folder.file("raw.y4m");
    write_y4m(path, 5, cut);
    VideoReader video;
    ASSERT_TRUE(video.open(path)) << video.problem();
    int frames = 0;
    for (cv::Mat grey; video.read(grey); ++frames)  // of the range 16 to 235
      EXPECT_NEAR(grey.at<std::uint8_t>(40, 60), (40 + 2 * frames - 16) * 255 / 219, 2);
    EXPECT_EQ(frames, cut == 0 ? 5 : 4);
    EXPECT_EQ(video.missing(), cut == 0 ? "" : "ends after 4 frames, inside a frame");
  }
}

}  // namespace
}  // namespace heel
