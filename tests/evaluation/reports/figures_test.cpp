// The figures that `heel report` draws of a run: PNG and SVG, their sizes, and that the lines are in them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "evaluation/reports/synthetic_run.h"
#include "support/environment.h"
#include "support/figure.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::count_of;
using test::Outcome;
using test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr unsigned kPersonLine = 0xd55e00, kRobotLine = 0x0072b2, kQuadrilateral = 0x2be34a;

class Figures : public ::testing::Test {
 protected:
  Figures() { test::write_run(folder_); }
  Outcome report() { return test::run_heel({"report", folder_.path().string()}); }

  TemporaryFolder folder_;
};

TEST_F(Figures, OfARunShowItsLinesAndPictures) {
  test::keep_frames(folder_, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 50});
  const Outcome outcome = report();
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");

  const cv::Mat path = test::expect_figure(folder_.file("path"), {1200, 810});
  EXPECT_GT(count_of(path, kPersonLine), 400);
  EXPECT_GT(count_of(path, kRobotLine), 400);

  const cv::Mat errors = test::expect_figure(folder_.file("errors"), {1200, 1530});
  for (int i = 0; i < 5; ++i)
    EXPECT_GT(count_of(errors.rowRange(306 * i, 306 * (i + 1)), kRobotLine), 100) << "panel " << i;
  EXPECT_GT(count_of(errors.rowRange(306 * 4, 306 * 5), kPersonLine), 100) << "the commanded yaw rate";

  // Three rows of four pictures, each 4 : 3 with its caption beneath.
  const cv::Mat frames = test::expect_picture(folder_.file("frames.png"), {1620, 1025});
  const auto tile = [&](int i) { return frames(cv::Rect(405 * (i % 4), 341 * (i / 4), 405, 341)); };
  const cv::Rect shown = cv::boundingRect(test::pixels_of(tile(0), kQuadrilateral));
  const double scale = (405.0 - 8.0) / 320.0;
  EXPECT_NEAR(shown.x, 6 + scale * 100, 6) << "the homography is the identity";
  EXPECT_NEAR(shown.y, 6 + scale * 60, 6);
  EXPECT_NEAR(shown.width, scale * 120, 8);
  EXPECT_NEAR(shown.height, scale * 90, 8);
  EXPECT_EQ(count_of(tile(11), kQuadrilateral), 0) << "frame 50, in which the target was not found";
}

TEST_F(Figures, ARunWithoutAnyFrameIsDrawn) {
  test::record_run(folder_, /*with_poses=*/false);
  EXPECT_EQ(report().status, 1);
  test::expect_figure(folder_.file("path"), {1200, 810});
  test::expect_figure(folder_.file("errors"), {1200, 1530});
}

TEST_F(Figures, TheSameNumbersMakeTheSameFiles) {
  report();
  const std::string png = test::read_text(folder_.file("path.png"));
  const std::string svg = test::read_text(folder_.file("path.svg"));
  report();
  EXPECT_EQ(test::read_text(folder_.file("path.png")), png);
  EXPECT_EQ(test::read_text(folder_.file("path.svg")), svg);
}

TEST_F(Figures, WithoutMatplotlibTheNumbersAreWrittenAndThePackageIsNamed) {
  const std::string without = test::write_text(folder_.file("plots"), "#!/bin/sh\nexit 3\n");
  std::filesystem::permissions(without, std::filesystem::perms::owner_all);
  const test::ScopedEnvironment plots("HEEL_PLOTS", without);
  const Outcome outcome = report();
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err,
            "heel report: no figures: matplotlib for Python 3 is missing (install the Debian package "
            "python3-matplotlib)\n");
  EXPECT_EQ(outcome.out, test::read_text(folder_.file("summary.txt")));
  for (const char* file : {"summary.json", "path.csv", "pose_errors.csv", "commands.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder_.file(file))) << file;
  EXPECT_FALSE(std::filesystem::exists(folder_.file("path.png")));
}

}  // namespace
}  // namespace heel
