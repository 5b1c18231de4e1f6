// Frames from images, folders and videos: order, numbers, times, and which files count as images.
#include "files/frame_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <string>
#include <vector>

#include "files/image_file.h"
#include "files/video_reader.h"
#include "heel/error.h"
#include "support/complaint.h"
#include "support/made_video.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

class FrameInputTest : public ::testing::Test {
 protected:
  std::string image(const std::string& name, int grey) {
    const std::string path = folder_.file(name);
    cv::imwrite(path, cv::Mat(16, 32, CV_8UC1, cv::Scalar(grey)));
    return path;
  }
  std::string video(int frames) {
    const std::string path = folder_.file("video.avi");
    cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10.0,
                           cv::Size(64, 48));
    for (int i = 0; i < frames; ++i) writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(40 + 40 * i)));
    return path;
  }

  test::TemporaryFolder folder_;
};

TEST_F(FrameInputTest, NumbersFramesAcrossAllInputs) {
  std::filesystem::create_directory(folder_.file("walk"));
  image("walk/10.png", 10);
  image("walk/9.png", 9);
  test::write_text(folder_.file("walk/notes.txt"), "not an image");
  FrameInput input({folder_.file("walk"), video(3), image("last.png", 77)}, 5.0);
  EXPECT_EQ(input.stated_frame_count(), 6U);
  const std::vector<double> greys{9, 10, 40, 80, 120, 77};
  const std::vector<double> times_s{0.0, 0.2, 0.4, 0.5, 0.6, 0.8};
  InputFrame frame;
  for (std::size_t i = 0; i < greys.size(); ++i) {
    ASSERT_TRUE(input.next(frame)) << i;
    EXPECT_EQ(frame.number, i);
    EXPECT_NEAR(frame.t_s, times_s[i], 1e-6) << i;
    EXPECT_NEAR(frame.grey.at<std::uint8_t>(8, 8), greys[i], 3) << "frame " << i << "; MJPEG is not exact";
  }
  EXPECT_FALSE(input.next(frame));
}

TEST_F(FrameInputTest, SkipsFramesWithoutChangingTheirNumbers) {
  FrameInput input({image("first.png", 5), video(3)}, 5.0);
  EXPECT_TRUE(input.skip(2));
  InputFrame frame;
  ASSERT_TRUE(input.next(frame));
  EXPECT_EQ(frame.number, 2U);
  EXPECT_NEAR(frame.grey.at<std::uint8_t>(8, 8), 80, 3);
  EXPECT_FALSE(input.skip(2)) << "one frame is left";
  EXPECT_EQ(input.frames_passed(), 4U);
}

/// A camera that leaves the end marker out does so in every picture.
TEST_F(FrameInputTest, ThatTheEndsOfPicturesAreMissingIsSaidOnce) {
  std::filesystem::create_directory(folder_.file("walk"));
  for (const char* name : {"walk/1.jpg", "walk/2.jpg"}) {
    const std::string whole = test::read_text(image(name, 90));
    test::write_text(folder_.file(name), whole.substr(0, whole.size() - 2));
  }
  FrameInput input({folder_.file("walk")}, 5.0);
  InputFrame frame;
  int frames = 0;
  while (input.next(frame)) ++frames;
  EXPECT_EQ(frames, 2);
  ASSERT_EQ(input.notes().size(), 1U);
  EXPECT_THAT(input.notes()[0], ::testing::HasSubstr("walk/1.jpg: its end is missing"));
}

TEST_F(FrameInputTest, AnImageIsRecognisedByItsEndingOrItsContent) {
  const std::string png = image("picture.png", 1);
  std::filesystem::copy(png, folder_.file("without_ending"));
  const std::string damaged = test::write_text(folder_.file("damaged.JPG"), "no image at all");
  const std::string text = test::write_text(folder_.file("notes.txt"), "not an image");
  EXPECT_TRUE(is_image_file(png));
  EXPECT_TRUE(is_image_file(folder_.file("without_ending")));
  EXPECT_TRUE(is_image_file(damaged));
  EXPECT_FALSE(is_image_file(text));
  EXPECT_THROW(read_grey_image(damaged), Error);
  EXPECT_THROW(FrameInput({text}, 5.0), Error);
}

TEST_F(FrameInputTest, APipeIsRefusedAndNotWaitedFor) {
  for (const char* name : {"pipe", "pipe.png", "pipe.mp4"}) {
    const std::string path = folder_.file(name);
    ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
    const std::string refusal = path + ": cannot read: expected a regular file";
    EXPECT_EQ(test::complaint_of([&] { FrameInput({path}, 5.0); }), refusal);
    EXPECT_EQ(test::complaint_of([&] { read_grey_image(path); }), refusal);
    EXPECT_EQ(is_image_file(path), path.ends_with(".png")) << "by its name, not by what is read from it";
    VideoReader video;
    EXPECT_FALSE(video.open(path));
    EXPECT_EQ(video.problem(), "no regular file");
  }
}

TEST_F(FrameInputTest, JpegPicturesOneAfterAnotherAreAVideo) {
  std::string stream;
  for (const int grey : {40, 90, 140}) {
    std::vector<std::uint8_t> jpeg;
    cv::imencode(".jpg", cv::Mat(48, 64, CV_8UC1, cv::Scalar(grey)), jpeg);
    stream.append(jpeg.begin(), jpeg.end());
  }
  for (const char* name : {"walk.mjpeg", "walk.MJPG"}) {
    FrameInput input({test::write_text(folder_.file(name), stream)}, 5.0);
    InputFrame frame;
    for (const int grey : {40, 90, 140}) {
      ASSERT_TRUE(input.next(frame)) << name << grey;
      EXPECT_NEAR(frame.grey.at<std::uint8_t>(8, 8), grey, 3);
    }
    EXPECT_GT(frame.t_s, 0.0);
    EXPECT_FALSE(input.next(frame));
    EXPECT_THAT(input.problems(), ::testing::IsEmpty());
  }
}

TEST_F(FrameInputTest, WhatIsMissingOfAVideoIsSaidWhenItsFramesHaveBeenUsed) {
  const std::string path = folder_.file("cut.mkv");
  test::MadeVideo made{.path = path, .greys = {}, .times_s = {}, .display_abcd = {}};
  for (int i = 0; i < 20; ++i) {
    made.greys.emplace_back(48, 64, CV_8U);
    cv::randu(made.greys.back(), 0, 255);
    made.times_s.push_back(0.1 * i);
  }
  test::write_video(made);
  test::cut_file(path, 0.5);
  for (const bool skipped : {false, true}) {
    FrameInput input({path, image("last.png", 77)}, 5.0);
    InputFrame frame;
    if (skipped) {
      EXPECT_FALSE(input.skip(30));
    } else {
      ASSERT_TRUE(input.next(frame));
      EXPECT_THAT(input.problems(), ::testing::IsEmpty()) << "its end has not been reached";
      while (input.next(frame)) continue;
      EXPECT_EQ(frame.file, folder_.file("last.png")) << "the next input is used as well";
    }
    const std::string frames = std::to_string(input.frames_passed() - 1);
    EXPECT_THAT(input.problems(), ::testing::ElementsAre(path + ": ends after " + frames + " of 20 frames"));
  }
}

TEST_F(FrameInputTest, TheDepthOfPicturesIsSaidOnceAndKept) {
  std::vector<std::string> paths;
  for (const int white : {3000, 4000, 900}) {
    paths.push_back(folder_.file(std::to_string(white) + ".png"));
    cv::imwrite(paths.back(), cv::Mat(16, 32, CV_16UC1, cv::Scalar(white)));
  }
  FrameInput input(paths, 5.0);
  InputFrame frame;
  for (const double grey : {3000 * 255.0 / 4095, 4000 * 255.0 / 4095, 900 * 255.0 / 4095}) {
    ASSERT_TRUE(input.next(frame));
    EXPECT_NEAR(frame.grey.at<std::uint8_t>(8, 8), grey, 0.51);
  }
  ASSERT_EQ(input.notes().size(), 1u);
  EXPECT_THAT(input.notes()[0], ::testing::HasSubstr("3000.png: 16 bits a pixel, of which 12 are used"));
}

TEST_F(FrameInputTest, AnInterlacedVideoIsNotedOnce) {
  test::MadeVideo video{.path = folder_.file("fields.mp4"), .greys = {}, .times_s = {}, .display_abcd = {}};
  video.interlaced = true;
  for (int i = 0; i < 3; ++i) {
    video.greys.emplace_back(48, 64, CV_8U, cv::Scalar(100));
    video.times_s.push_back(0.1 * i);
  }
  test::write_video(video);
  FrameInput input({video.path, image("plain.png", 9), video.path}, 5.0);
  for (InputFrame frame; input.next(frame);) {
  }
  const std::string note = video.path + ": interlaced: every second row is used";
  EXPECT_EQ(input.notes(), (std::vector<std::string>{note, note})) << "one for each input";
}

TEST_F(FrameInputTest, HiddenFilesOfAFolderAreNoPictures) {
  std::filesystem::create_directory(folder_.file("stick"));
  image("stick/a.png", 10);
  test::write_text(folder_.file("stick/._a.png"), std::string("\0\x05\x16\x07", 4));
  FrameInput input({folder_.file("stick")}, 5.0);
  InputFrame frame;
  EXPECT_TRUE(input.next(frame));
  EXPECT_FALSE(input.next(frame));
}

TEST_F(FrameInputTest, VideosInAFolderOfPicturesAreSaidToBePassedOver) {
  std::filesystem::create_directory(folder_.file("walk"));
  std::filesystem::rename(video(2), folder_.file("walk/b.avi"));
  const std::string only_video =
      folder_.file("walk") +
      ": no image in this folder (expected at least one); b.avi in it is a video, which is passed over: give "
      "it by its name";
  EXPECT_EQ(test::complaint_of([&] { FrameInput({folder_.file("walk")}, 5.0); }), only_video);
  image("walk/a.png", 10);
  test::write_text(folder_.file("walk/notes.txt"), "no video");
  EXPECT_THAT(
      FrameInput({folder_.file("walk")}, 5.0).notes(),
      ::testing::ElementsAre(::testing::HasSubstr("walk: b.avi in it is a video, which is passed over")));
  std::filesystem::rename(video(2), folder_.file("walk/c.AVI"));
  EXPECT_THAT(FrameInput({folder_.file("walk")}, 5.0).notes(),
              ::testing::ElementsAre(::testing::HasSubstr("b.avi and 1 more videos in it are passed over")));
}

TEST_F(FrameInputTest, WhatStandsInAPicturesPlaceIsNamed) {
  struct Other {
    std::string bytes, named;
  };
  const std::vector<Other> others{
      {"", "an empty file"},
      {"version https://git-lfs.github.com/spec/v1\noid sha256:4d", "a Git LFS pointer"},
      {"\r\n<!DOCTYPE html>\n<html>", "a web page"},
      {"<HTML><head>", "a web page"},
      {"#ROSBAG V2.0\n", "a ROS bag"},
      {"\x89MCAP0\r\n", "a ROS bag"},
      {"SQLite format 3", "a ROS bag"},
      {"PK\x03\x04walk.png", "a compressed archive"},
      {"\x1f\x8b\x08", "a compressed archive"}};
  for (const Other& other : others) {
    for (const char* name : {"walk.png", "walk.mp4", "walk"}) {
      const std::string path = test::write_text(folder_.file(name), other.bytes);
      const std::string line = test::complaint_of([&] {
        FrameInput input({path}, 5.0);
        InputFrame frame;
        input.next(frame);
      });
      EXPECT_THAT(line, ::testing::HasSubstr(other.named)) << name;
      EXPECT_THAT(line, ::testing::StartsWith(path));
    }
  }
  EXPECT_THAT(test::complaint_of([] { FrameInput({"http://camera/walk.mp4"}, 5.0); }),
              ::testing::HasSubstr("expected a file on this computer"));
}

}  // namespace
}  // namespace heel
