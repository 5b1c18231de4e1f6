// The pictures: their sizes, that they show what they are to show, and that they are to scale.
#include "evaluation/reports/figures.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "evaluation/reports/plot.h"
#include "evaluation/reports/run_files.h"
#include "evaluation/reports/synthetic_run.h"
#include "files/template_file.h"
#include "heel/shirt_template.h"

namespace heel {
namespace {

using test::TemporaryFolder;

const cv::Scalar kRed(0, 0, 255);
const cv::Scalar kLostDot(40, 40, 220);
const cv::Scalar kPersonLine(40, 130, 230);
const cv::Scalar kRobotLine(170, 80, 20);

/// Where the picture has this colour, within what smoothing leaves.
cv::Mat where(const cv::Mat& picture, const cv::Scalar& bgr) {
  cv::Mat mask;
  cv::inRange(picture, bgr - cv::Scalar::all(12), bgr + cv::Scalar::all(12), mask);
  return mask;
}

int count(const cv::Mat& picture, const cv::Scalar& bgr) {
  return cv::countNonZero(where(picture, bgr));
}

class Figures : public ::testing::Test {
 protected:
  Figures() {
    test::write_run(folder_);
    run_ = evaluation::read_run(folder_.path().string());
  }

  /// `frames` kept frames, the first of the run and then every fifth, and a template whose region is known.
  void keep_frames(int frames) {
    ShirtTemplate shirt;
    shirt.camera = {.width_px = 320, .height_px = 240, .fx = 300, .fy = 300, .cx = 160, .cy = 120};
    shirt.grey.assign(320 * 240, 128);
    shirt.roi = {.x_px = 100, .y_px = 60, .width_px = 120, .height_px = 90};
    shirt.distance_m = 1.5;
    write_template(shirt, folder_.file("shirt.heel"));
    std::filesystem::create_directory(folder_.file("frames"));
    for (int i = 0; i < frames; ++i)
      cv::imwrite(folder_.file("frames/" + test::printed("%06d.png", 5 * i)),
                  cv::Mat(240, 320, CV_8U, cv::Scalar::all(10 + 10 * i)));
  }

  TemporaryFolder folder_;
  evaluation::MetricsCollector run_;
};

TEST_F(Figures, PathShowsBothPathsAndWhereTheTargetWasNotFound) {
  const cv::Mat figure = evaluation::path_figure(run_, run_.evaluate());
  EXPECT_EQ(figure.size(), cv::Size(1100, 740));
  EXPECT_GT(count(figure, kPersonLine), 400);
  EXPECT_GT(count(figure, kRobotLine), 400);
  EXPECT_GT(count(figure, kLostDot), 20);
}

TEST_F(Figures, ThereIsNoLegendForLostTargetsWhenNoneWasLost) {
  evaluation::MetricsCollector found;
  for (const evaluation::MotionSample& sample : run_.motion()) found.add(sample);
  for (evaluation::PoseSample pose : run_.poses()) {
    pose.found = true;
    found.add(pose);
  }
  EXPECT_EQ(count(evaluation::path_figure(found, found.evaluate()), kLostDot), 0);
}

TEST_F(Figures, ErrorsShowFivePanels) {
  const cv::Mat figure = evaluation::errors_figure(run_);
  EXPECT_EQ(figure.size(), cv::Size(1100, 5 * 270));
  for (int i = 0; i < 5; ++i)
    EXPECT_GT(count(figure.rowRange(270 * i, 270 * (i + 1)), kRobotLine), 100) << "panel " << i;
  EXPECT_GT(count(figure.rowRange(270 * 4, 270 * 5), kPersonLine), 100) << "the commanded yaw rate";
}

TEST_F(Figures, FramesFillWholeRowsAndShowTheRegion) {
  EXPECT_TRUE(evaluation::frames_figure(folder_.path().string()).empty()) << "none was kept";
  keep_frames(17);
  const cv::Mat sheet = evaluation::frames_figure(folder_.path().string());
  // Three rows of four, 400 × 300 each with a border of 2.
  ASSERT_EQ(sheet.size(), cv::Size(4 * 404, 3 * 304));
  const auto tile = [&](int i) { return sheet(cv::Rect(404 * (i % 4), 304 * (i / 4), 404, 304)); };
  EXPECT_EQ(tile(0).at<cv::Vec3b>(20, 20)[0], 10) << "the first frame";
  EXPECT_EQ(tile(11).at<cv::Vec3b>(20, 20)[0], 170) << "the last frame";
  const cv::Scalar green(60, 220, 60);
  // The homography is the identity: the region stands where it stands in the template, 1.25 times as large.
  const cv::Rect shown = cv::boundingRect(where(tile(0), green));
  EXPECT_NEAR(shown.x, 2 + 1.25 * 100, 4);
  EXPECT_NEAR(shown.y, 2 + 1.25 * 60, 4);
  EXPECT_NEAR(shown.width, 1.25 * 120, 6);
  EXPECT_NEAR(shown.height, 1.25 * 90, 6);
  EXPECT_EQ(count(tile(7), green), 0) << "frame 50, in which the target was not found";
}

TEST_F(Figures, FewFramesStandInOneRowAndBrokenOnesAreLeftOut) {
  keep_frames(3);
  test::write_text(folder_.file("frames/000015.png"), "half a pict");
  EXPECT_EQ(evaluation::frames_figure(folder_.path().string()).size(), cv::Size(3 * 404, 304));
}

TEST(Plot, EqualScaleHoldsWhateverTheShape) {
  for (const auto& [width_m, height_m] : {std::pair(6.0, 0.5), std::pair(1.0, 1.0), std::pair(1.0, 4.0)}) {
    SCOPED_TRACE(test::printed("%g x %g m", width_m, height_m));
    const evaluation::Series box{
        "", kRed, {{0, 0}, {width_m, 0}, {width_m, height_m}, {0, height_m}, {0, 0}}, 1.0, false};
    const cv::Mat figure = evaluation::plot({"", "x", "y", true, false, {}}, {box}, 900, 500);
    const cv::Rect drawn = cv::boundingRect(where(figure, kRed));
    const double px_per_m = std::max((drawn.width - 1) / width_m, (drawn.height - 1) / height_m);
    EXPECT_NEAR(drawn.width - 1, px_per_m * width_m, 2.5);
    EXPECT_NEAR(drawn.height - 1, px_per_m * height_m, 2.5);
  }
}

TEST(Plot, TheLegendStandsOutsideTheAxes) {
  // A curve along all four edges of the axes: no legend in any corner may cover it.
  evaluation::Series edge{"", kRed, {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}, 2.0, false};
  const cv::Mat without = where(evaluation::plot({"", "x", "y", false, false, {}}, {edge}, 900, 500), kRed);
  edge.name = "a curve with a long name that takes its place";
  cv::Mat with = where(evaluation::plot({"", "x", "y", false, false, {}}, {edge}, 900, 500), kRed);
  cv::Mat covered = without & ~with;
  EXPECT_EQ(cv::countNonZero(covered), 0);
  EXPECT_GT(cv::countNonZero(with), cv::countNonZero(without)) << "the legend's sample of the line";
}

}  // namespace
}  // namespace heel
