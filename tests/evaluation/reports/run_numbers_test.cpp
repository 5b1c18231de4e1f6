// The numbers of a run's figures, from a run calculated by hand.
#include "evaluation/reports/run_numbers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "core/angles.h"
#include "evaluation/reports/run_files.h"
#include "evaluation/reports/synthetic_run.h"
#include "files/csv_table.h"

namespace heel {
namespace {

using test::TemporaryFolder;

class RunNumbers : public ::testing::Test {
 protected:
  RunNumbers() {
    test::write_run(folder_);
    const evaluation::MetricsCollector run = evaluation::read_run(folder_.path().string());
    evaluation::write_run_numbers(folder_.path().string(), run, run.evaluate());
  }
  CsvTable table(const std::string& name) const { return CsvTable(folder_.file(name)); }

  TemporaryFolder folder_;
};

TEST_F(RunNumbers, ThePathHoldsRobotAndPersonAndWhetherThePersonWalks) {
  const CsvTable path = table("path.csv");
  ASSERT_EQ(path.rows(), 101U);
  EXPECT_EQ(path.number(0, "t_s"), 0.0) << "time counts from the start of the run";
  EXPECT_NEAR(path.number(100, "t_s"), 10.0, 1e-9);
  EXPECT_EQ(path.number(19, "walking"), 0.0);
  EXPECT_EQ(path.number(20, "walking"), 1.0);
  EXPECT_NEAR(path.number(80, "robot_x_m"), 1.0, 1e-9);
  EXPECT_NEAR(path.number(80, "robot_y_m"), -0.1, 1e-9);
  EXPECT_NEAR(path.number(80, "person_x_m"), 3.0, 1e-9);
  EXPECT_EQ(path.number(80, "person_y_m"), 0.0);
}

TEST_F(RunNumbers, ARowHoldsThePoseTheTruthAndTheRobotsPlace) {
  const CsvTable poses = table("pose_errors.csv");
  ASSERT_EQ(poses.rows(), 100U);
  EXPECT_NEAR(poses.number(30, "t_s"), 3.05, 1e-9);
  EXPECT_EQ(poses.number(30, "found"), 1.0);
  EXPECT_NEAR(poses.number(30, "certainty"), 0.3, 1e-9);
  EXPECT_NEAR(poses.number(30, "true_yaw_deg"), kDegPerRad * 0.02 * 30.5, 1e-3);
  EXPECT_NEAR(poses.number(30, "yaw_deg"), kDegPerRad * (0.02 * 30.5 + test::kEvenYawError_rad), 1e-3);
  EXPECT_NEAR(poses.number(31, "yaw_deg"), kDegPerRad * (0.02 * 31.5 + test::kOddYawError_rad), 1e-3);
  EXPECT_NEAR(poses.number(30, "z_m") - poses.number(30, "true_z_m"), test::kZError_m, 1e-9);
  EXPECT_EQ(poses.number(30, "x_m"), 0.0);
  EXPECT_NEAR(poses.number(30, "robot_x_m"), 0.05 * 11 - 2.0, 1e-9) << "of the next row of truth";
  EXPECT_NEAR(poses.number(30, "robot_y_m"), 0.3, 1e-9);
}

TEST_F(RunNumbers, ATargetThatIsNotFoundHasNoEstimate) {
  const CsvTable poses = table("pose_errors.csv");
  int lost = 0;
  for (std::size_t i = 0; i < poses.rows(); ++i) {
    const bool found = poses.number(i, "found") != 0.0;
    EXPECT_EQ(found, i < 50 || i >= 55) << i;
    for (const char* column : {"yaw_deg", "true_yaw_deg", "x_m", "true_x_m", "z_m", "true_z_m"})
      EXPECT_EQ(std::isfinite(poses.number(i, column)), found) << column << " of row " << i;
    if (found) continue;
    if (poses.number(i, "walking") != 0.0) ++lost;
    EXPECT_EQ(poses.number(i, "certainty"), 0.0);
  }
  EXPECT_EQ(lost, 5);
}

TEST_F(RunNumbers, CommandsAreThoseOfTheTicks) {
  const CsvTable commands = table("commands.csv");
  ASSERT_EQ(commands.rows(), 101U);
  EXPECT_NEAR(commands.number(29, "t_s"), 2.9, 1e-9);
  EXPECT_NEAR(commands.number(29, "v_m_s"), 0.5, 1e-9);
  EXPECT_EQ(commands.number(30, "v_m_s"), 0.0) << "the target is lost";
  EXPECT_NEAR(commands.number(30, "yaw_rate_rad_s"), -0.2, 1e-9);
}

class KeptFrames : public RunNumbers {
 protected:
  void write() { evaluation::write_kept_frames(folder_.path().string(), test::kClock_s); }
};

TEST_F(KeptFrames, TwelveAreChosenEvenlyEachWithTheRegion) {
  EXPECT_FALSE(std::filesystem::exists(folder_.file("frames.csv"))) << "no frame was kept";
  std::vector<int> numbers;
  for (int i = 0; i < 17; ++i) numbers.push_back(5 * i);
  test::keep_frames(folder_, numbers);
  write();
  const CsvTable frames = table("frames.csv");
  ASSERT_EQ(frames.rows(), 12U) << "three rows of four";
  EXPECT_EQ(frames.text(0, "file"), "frames/000000.png");
  EXPECT_EQ(frames.text(11, "file"), "frames/000080.png");
  EXPECT_NEAR(frames.number(11, "t_s"), 8.05, 1e-9);
  EXPECT_NEAR(frames.number(11, "yaw_deg"), kDegPerRad * (0.02 * 80.5 + test::kEvenYawError_rad), 0.01);
  EXPECT_NEAR(frames.number(11, "certainty"), 0.3, 1e-9);
  // The homography is the identity: the region is where it is in the template.
  const double corners[4][2] = {{100, 60}, {220, 60}, {220, 150}, {100, 150}};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(frames.number(0, test::printed("corner_%d_x_px", i)), corners[i][0], 0.01) << "corner " << i;
    EXPECT_NEAR(frames.number(0, test::printed("corner_%d_y_px", i)), corners[i][1], 0.01) << "corner " << i;
  }
  EXPECT_EQ(frames.text(7, "file"), "frames/000050.png") << "the target was not found in it";
  EXPECT_EQ(frames.number(7, "found"), 0.0);
  EXPECT_TRUE(std::isnan(frames.number(7, "corner_0_x_px")));
}

TEST_F(KeptFrames, AFewFramesAreAllShownAndUnreadableOnesAreLeftOut) {
  test::keep_frames(folder_, {0, 5, 10});
  test::write_text(folder_.file("frames/000015.png"), "half a pict");
  write();
  EXPECT_EQ(table("frames.csv").rows(), 3U);
}

}  // namespace
}  // namespace heel
