// heel calibrate from a video: the sharpest frames, compared with truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <string>

#include "files/camera_info.h"
#include "support/made_video.h"
#include "tools/heel/rendered_board.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::Outcome;
using ::testing::HasSubstr;

class CalibrateVideo : public ::testing::Test {
 protected:
  /// Each view is shown in six frames, of which one is not blurred.
  test::MadeVideo video_of_views(const std::string& name) const {
    test::MadeVideo video{.path = folder_.file(name), .greys = {}, .times_s = {}, .display_abcd = {}};
    for (const test::BoardPose& pose : test::kGoodPoses) {
      const cv::Mat sharp = test::render_board(pose);
      cv::Mat blurred;
      cv::GaussianBlur(sharp, blurred, {0, 0}, 9.0);
      for (int i = 0; i < 6; ++i) {
        video.times_s.push_back(0.05 * static_cast<double>(video.greys.size()));
        video.greys.push_back(i == 3 ? sharp : blurred);
      }
    }
    return video;
  }
  /// Its temporary files go to a folder of its own: other programs use the system's meanwhile.
  Outcome calibrate(const std::string& input) const {
    std::filesystem::create_directory(temporary_);
    return test::run_program({"/usr/bin/env", "TMPDIR=" + temporary_, test::built_program("heel"),
                              "calibrate", input, "--board", "9x6", "--square", "0.03", "-o", output_});
  }

  test::TemporaryFolder folder_;
  std::string temporary_ = folder_.file("temporary");
  std::string output_ = folder_.file("camera.yaml");
};

TEST_F(CalibrateVideo, TheSharpestFramesGiveTheTrueCamera) {
  const test::MadeVideo video = video_of_views("board.mp4");
  test::write_video(video);
  const Outcome outcome = calibrate(video.path);
  ASSERT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("board.mp4/00003.png"));
  const CameraModel camera = read_camera_model(output_);
  // 1.5 %: MPEG-4 moves the corners a little, and the blurred frames show the board as well.
  EXPECT_NEAR(camera.fx, test::kTrueK(0, 0), 9.0);
  EXPECT_NEAR(camera.fy, test::kTrueK(1, 1), 9.0);
  EXPECT_NEAR(camera.cx, test::kTrueK(0, 2), 4.0);
  EXPECT_NEAR(camera.cy, test::kTrueK(1, 2), 4.0);
  EXPECT_TRUE(std::filesystem::is_empty(temporary_)) << "its frames are removed";
}

TEST_F(CalibrateVideo, OfACutVideoWhatIsThereIsUsedAndTheRestNamed) {
  test::MadeVideo video = video_of_views("board.mkv");
  test::write_video(video);
  test::cut_file(video.path, 0.9);
  const Outcome outcome = calibrate(video.path);
  EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  EXPECT_THAT(outcome.err, HasSubstr("board.mkv: ends after"));
}

TEST_F(CalibrateVideo, WhatIsNoVideoIsNamed) {
  const Outcome outcome = calibrate(test::write_text(folder_.file("notes.txt"), "no board"));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("notes.txt: not an image or video"));
  EXPECT_EQ(calibrate(folder_.file("absent.mp4")).status, 2);
}

}  // namespace
}  // namespace heel
