// Each robot of the family, through heeld's session and gate, against the simulated robot's truth.
#include "evaluation/experiments/robot_family.h"

#include <gtest/gtest.h>

#include <numbers>

#include "models/robot_models.h"

namespace heel::evaluation {
namespace {

TEST(RobotFamily, OdometryIsTheTruthAndTheWallIsKeptClear) {
  const Config config;
  std::vector<std::pair<std::size_t, std::size_t>> progress;
  const std::vector<FamilyDrive> drives = drive_family(config, 3, [&](std::size_t done, std::size_t of) {
    progress.push_back({done, of});
  });
  ASSERT_EQ(drives.size(), robot_models().size());
  ASSERT_EQ(progress.size(), drives.size());
  EXPECT_EQ(progress.front(), (std::pair<std::size_t, std::size_t>(1, drives.size())));
  EXPECT_EQ(progress.back().first, progress.back().second);
  for (const FamilyDrive& drive : drives) {
    SCOPED_TRACE(drive.subclass);
    EXPECT_GE(drive.straight_truth_m, 5.0);
    EXPECT_NEAR(drive.straight_odometry_m, drive.straight_truth_m, 0.01);
    EXPECT_GE(drive.turn_truth_rad, 2.0 * std::numbers::pi);
    EXPECT_NEAR(drive.turn_odometry_rad, drive.turn_truth_rad, 0.01);
    EXPECT_NEAR(drive.speed_truth_m_s, 0.4, 0.01) << "VEL is in mm/s on all of them";
    EXPECT_NEAR(drive.speed_odometry_m_s, drive.speed_truth_m_s, 0.01);
    EXPECT_GT(drive.wall_speed_m_s, 0.5) << "it must have had something to brake";
    // The AmigoBot's foremost beams, at 15°, leave its narrow way 0.7 m ahead: it sees the wall late.
    const bool is_amigo = drive.subclass.starts_with("amigo");
    EXPECT_GT(drive.wall_gap_m, config.gate.clearance_m - (is_amigo ? 0.1 : 0.05));
    EXPECT_LT(drive.wall_gap_m, config.gate.clearance_m + 0.15);
  }
}

}  // namespace
}  // namespace heel::evaluation
