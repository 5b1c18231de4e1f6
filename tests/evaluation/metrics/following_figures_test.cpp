// The figures of following, of synthetic runs whose figures are known.
#include "evaluation/metrics/following_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "heel/flow.h"

namespace heel::evaluation {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kBackBehind_m = 0.1;

/// A person who walks 10 m along x at 0.5 m/s, and a robot `behind_m` behind their back, `beside_m` to the
/// left.
struct WalkInLine {
  FollowReference reference{.set_distance_m = 1.6, .camera_x_m = 0.1, .camera_y_m = 0.0, .separation_m = 0.8};
  std::vector<MotionSample> motion;
  std::vector<PoseSample> poses;
  std::vector<TickSample> ticks;

  explicit WalkInLine(double behind_m = 1.6, double beside_m = 0.0) {
    for (int i = 0; i <= 1000; ++i) {
      MotionSample sample;
      sample.t_s = kTick_s * i;
      sample.has_person = sample.has_back = sample.back_in_view = true;
      sample.person = {0.5 * sample.t_s, 0.0, 0.0};
      sample.person_speed_m_s = 0.5;
      sample.back_x_m = sample.person.x_m - kBackBehind_m;
      sample.robot = {sample.back_x_m - behind_m, beside_m, 0.0};
      motion.push_back(sample);
      ticks.push_back({sample.t_s, to_string(StopReason::None), 0.5, 0.0});
      PoseSample pose;
      pose.t_s = sample.t_s;
      pose.found = true;
      poses.push_back(pose);
    }
  }
  FollowingFigures figures() const { return following_figures(motion, poses, ticks, reference); }
};

TEST(FollowingFigures, APerfectRunHasNoErrors) {
  const FollowingFigures f = WalkInLine().figures();
  EXPECT_NEAR(f.path_max_m, 0.0, 1e-9);
  EXPECT_LT(f.along_p95_m, 0.011);  // the path has a point every centimetre
  EXPECT_EQ(f.along_within_share, 1.0);
  EXPECT_EQ(f.separation_entries, 0);
  EXPECT_NEAR(f.jerk_p99_m_s3, 0.0, 1e-9);
  EXPECT_NEAR(f.straight_yaw_rate_rms_rad_s, 0.0, 1e-12);
  EXPECT_GT(f.straight_s, 14.0);  // all but the metres before the robot is a metre into the path
  EXPECT_EQ(f.yaw_within_share, 1.0);
  EXPECT_EQ(f.out_of_sight_share, 0.0);
  EXPECT_EQ(f.found_again_s.count, 0U);
  EXPECT_EQ(f.contacts, 0);
  EXPECT_TRUE(f.followed_to_end);
}

TEST(FollowingFigures, BesideAndAlongThePath) {
  const FollowingFigures f = WalkInLine(2.1, -0.2).figures();
  EXPECT_NEAR(f.path_p95_m, 0.2, 1e-9);
  EXPECT_NEAR(f.along_error_m.mean, 0.5, 0.011);
  EXPECT_EQ(f.along_within_share, 0.0);
  EXPECT_TRUE(f.followed_to_end);
  EXPECT_FALSE(WalkInLine(2.8).figures().followed_to_end);
}

TEST(FollowingFigures, APersonWhoWalksBackComesNearerAlongThePath) {
  WalkInLine run;
  // From the fifth second on they walk back towards a robot that stands.
  for (std::size_t i = 250; i < run.motion.size(); ++i) {
    const double back_m = std::min(0.5 * (run.motion[i].t_s - run.motion[250].t_s), 1.0);
    run.motion[i].person.x_m = run.motion[250].person.x_m - back_m;
    run.motion[i].back_x_m = run.motion[i].person.x_m - kBackBehind_m;
    run.motion[i].robot = run.motion[250].robot;
  }
  const FollowingFigures f = run.figures();
  EXPECT_NEAR(f.along_error_m.lowest, -1.0, 0.02);
  EXPECT_EQ(f.separation_entries, 1);  // 1.5 m from camera to back, less 1 m
}

TEST(FollowingFigures, JerkIsTheSecondDifferenceOfTheCommands) {
  WalkInLine run;
  for (std::size_t i = 0; i < run.ticks.size(); ++i)
    run.ticks[i].v_m_s = 0.5 * 2.0 * run.ticks[i].t_s * run.ticks[i].t_s;  // jerk 2
  EXPECT_NEAR(run.figures().jerk_p99_m_s3, 2.0, 1e-6);
}

TEST(FollowingFigures, YawRateCountsOnStraightPartsOnly) {
  WalkInLine run;
  for (TickSample& tick : run.ticks) tick.yaw_rate_rad_s = 0.02;
  EXPECT_NEAR(run.figures().straight_yaw_rate_rms_rad_s, 0.02, 1e-12);
  for (MotionSample& sample : run.motion) sample.person.heading_rad = 0.2 * sample.t_s;  // no straight part
  EXPECT_EQ(run.figures().straight_s, 0.0);
  EXPECT_EQ(run.figures().straight_yaw_rate_rms_rad_s, 0.0);
}

TEST(FollowingFigures, ViewContactsAndTheTimeUntilFoundAgain) {
  WalkInLine run;
  for (std::size_t i = 100; i < 150; ++i) {  // one second behind a pole
    run.motion[i].back_in_view = false;
    run.motion[i].back_hidden = true;
  }
  for (std::size_t i = 100; i < 165; ++i) run.poses[i].found = false;
  for (std::size_t i = 300; i < 310; ++i) run.motion[i].back_in_view = false;  // too short to be hidden
  for (std::size_t i = 400; i < 500; ++i) run.motion[i].back_yaw_rad = 0.9;
  for (std::size_t i = 600; i < 610; ++i) run.motion[i].touching = true;
  const FollowingFigures f = run.figures();
  ASSERT_EQ(f.found_again_s.count, 1U);
  EXPECT_NEAR(f.found_again_s.highest, 0.3, 1e-9);
  EXPECT_NEAR(f.out_of_sight_share, 10.0 / 1001.0, 1e-9);
  EXPECT_NEAR(f.yaw_within_share, 1.0 - 100.0 / 1001.0, 1e-9);
  EXPECT_EQ(f.contacts, 1);
}

TEST(FollowingFigures, ContactsOfARobotAtRestAreCountedApart) {
  WalkInLine run;
  for (const std::size_t begin : {300, 500, 700})
    for (std::size_t i = begin; i < begin + 10; ++i) run.motion[i].touching = true;
  run.motion[300].robot_v_m_s = 0.2;
  run.motion[700].robot_yaw_rate_rad_s = -0.5;
  for (std::size_t i = 501; i < 510; ++i) run.motion[i].robot_v_m_s = -0.6;  // after the contact
  const FollowingFigures f = run.figures();
  EXPECT_EQ(f.contacts, 3);
  EXPECT_EQ(f.contacts_at_rest, 1);
  EXPECT_NEAR(f.contact_m_s, 0.2, 0.001);
}

TEST(FollowingFigures, AStepSettlesAndOvershoots) {
  WalkInLine run;
  EXPECT_FALSE(run.figures().has_step);
  for (MotionSample& sample : run.motion) {
    // Moves from the second second on; from 0.5 m to -0.1 m in 3 s, and on the line from 6 s on.
    const double t_s = std::clamp(sample.t_s - 2.0, 0.0, 4.0);
    sample.robot = {-3.0 + 0.5 * std::max(sample.t_s - 2.0, 0.0), 0.5 - 0.2 * std::min(t_s, 3.0), 0.0};
    if (t_s > 3.0) sample.robot.y_m = -0.1 * (4.0 - t_s);
  }
  const FollowingFigures f = run.figures();
  ASSERT_TRUE(f.has_step);
  EXPECT_NEAR(f.settled_s, 3.5, 0.05);
  EXPECT_NEAR(f.settled_walking_s, 3.5, 0.05) << "the person walks already";
  EXPECT_NEAR(f.overshoot_share, 0.2, 0.01);
}

TEST(FollowingFigures, AStepThatBeginsWhileThePersonStandsCountsFromTheirFirstStep) {
  WalkInLine run;
  for (MotionSample& sample : run.motion) {
    // The robot moves from the start, the person from the second second on; on the line after 5 s.
    const double walked_m = 0.5 * std::max(sample.t_s - 2.0, 0.0);
    sample.person = {walked_m, 0.0, 0.0};
    sample.person_speed_m_s = walked_m > 0.0 ? 0.5 : 0.0;
    sample.robot = {-3.0 + 0.1 * sample.t_s, 0.5 - 0.1 * std::min(sample.t_s, 5.0), 0.0};
  }
  const FollowingFigures f = run.figures();
  ASSERT_TRUE(f.has_step);
  EXPECT_NEAR(f.settled_s, 4.4, 0.05);
  EXPECT_NEAR(f.settled_walking_s, 2.5, 0.05);
}

TEST(FollowingFigures, WithoutSamplesThereAreNone) {
  const FollowingFigures f = following_figures({}, {}, {}, {});
  EXPECT_EQ(f.along_error_m.count, 0U);
  EXPECT_FALSE(f.followed_to_end);
}

}  // namespace
}  // namespace heel::evaluation
