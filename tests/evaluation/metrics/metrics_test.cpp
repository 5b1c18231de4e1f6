// The figures of synthetic runs, whose figures are known.
#include "evaluation/metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace heel::evaluation {
namespace {

MotionSample motion(double t_s, double robot_x, double robot_y, double person_x, double speed) {
  MotionSample sample;
  sample.t_s = t_s;
  sample.robot = {robot_x, robot_y, 0};
  sample.has_person = true;
  sample.person = {person_x, 0, 0};
  sample.person_speed_m_s = speed;
  sample.back_in_view = true;
  return sample;
}

PoseSample pose(double t_s, bool found, double yaw_error) {
  PoseSample sample;
  sample.t_s = t_s;
  sample.found = found;
  sample.certainty = 0.3;
  sample.has_truth = true;
  sample.true_yaw_rad = 3.1;
  sample.yaw_rad = 3.1 + yaw_error - 2 * 3.14159265358979;  // a difference of a full turn is not an error
  sample.yaw_sigma_rad = 0.1;
  return sample;
}

TEST(Metrics, LateralDistanceIsSignedAlsoBehindTheStart) {
  const std::vector<Pose2> path{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}};
  EXPECT_NEAR(place_on_path(path, {-2, 0.3, 0}, 0).lateral_m, 0.3, 1e-12);
  EXPECT_NEAR(place_on_path(path, {0.5, -0.2, 0}, 0).lateral_m, -0.2, 1e-12);
  EXPECT_NEAR(place_on_path(path, {2.1, 0.5, 0}, 0).lateral_m, -0.1, 1e-12);
}

TEST(Metrics, PathsAndView) {
  MetricsCollector run;
  for (int i = 0; i <= 100; ++i) {
    MotionSample sample = motion(0.1 * i, 0.05 * i - 2, 0.1, i < 20 ? 0 : 0.05 * (i - 20), i < 20 ? 0 : 0.5);
    sample.back_in_view = i < 50 || i > 57;
    run.add(sample);
  }
  // Found except from t = 5.0 to 5.6 s; frames before the walk do not count.
  for (int i = 0; i <= 100; ++i)
    run.add(pose(0.1 * i, i > 15 && (i < 50 || i > 56), i % 2 == 0 ? 0.1 : -0.1));
  const FollowMetrics m = run.evaluate();
  EXPECT_NEAR(m.t_walk_begin_s, 2.0, 1e-9);
  EXPECT_NEAR(m.person_path_m, 4.0, 0.06);
  EXPECT_NEAR(m.lateral_m.rms, 0.1, 1e-9);
  EXPECT_NEAR(m.out_of_view_longest_s, 0.8, 1e-9);  // 4.9 → 5.7
  EXPECT_NEAR(m.out_of_view_total_s, 0.7, 1e-9);
  EXPECT_NEAR(m.truly_out_of_view_longest_s, 0.7, 1e-9);
  EXPECT_NEAR(m.yaw_error_rad.rms, 0.1, 1e-6);
  EXPECT_NEAR(m.yaw_nees, 1.0, 1e-6);
  EXPECT_EQ(m.frames, 81U);
  EXPECT_EQ(m.frames_found, 74U);
}

TEST(Metrics, StopsAreCountedByReason) {
  MetricsCollector run;
  for (int i = 0; i <= 10; ++i) run.add(motion(0.1 * i, 0, 0, 0.05 * i, 0.5));
  for (int i = 0; i <= 10; ++i) {
    TickSample tick;
    tick.t_s = 0.1 * i;
    tick.stop_reason = (i >= 3 && i < 5) || i >= 9 ? "target lost" : "following";
    run.add(tick);
  }
  const FollowMetrics m = run.evaluate();
  EXPECT_EQ(m.stops_by_reason.at("target lost"), 2);
  EXPECT_NEAR(m.rest_s_by_reason.at("target lost"), 0.4, 1e-9);
}

TEST(Metrics, ATargetFoundElsewhereIsWrong) {
  MetricsCollector run;
  for (int i = 0; i <= 10; ++i) {
    MotionSample sample = motion(0.1 * i, 0.05 * i - 2, 0, 0.05 * i, 0.5);
    sample.touching = i >= 7;
    run.add(sample);
    PoseSample seen = pose(0.1 * i, true, 0.0);
    seen.true_z_m = 2.0;
    seen.z_m = i < 4 ? 2.45 : 2.6;  // the limit is half a metre
    run.add(seen);
  }
  const FollowMetrics m = run.evaluate();
  EXPECT_EQ(m.frames_wrong, 7U);
  EXPECT_NEAR(m.touching_s, 0.4, 1e-9);
  EXPECT_NEAR(m.separation_end_m, 2.0, 1e-9);
}

TEST(Metrics, CriteriaNameWhatFailed) {
  FollowMetrics m;
  m.frames = 1;
  m.out_of_view_longest_s = 0.6;
  m.lateral_m.count = 1;
  m.lateral_m.rms = 0.2;
  m.robot_path_m = 5;
  EXPECT_TRUE(failed_criteria(m, {}).empty());
  EXPECT_TRUE(failed_criteria(m, {0.7, 0.3, 4.0}).empty());
  EXPECT_EQ(failed_criteria(m, {0.5, 0.1, 6.0}).size(), 3U);
  // A run without measurements meets no criterion.
  EXPECT_FALSE(failed_criteria(FollowMetrics{}, {0.5, 0.1, -1.0}).empty());
}

TEST(Metrics, Quantiles) {
  const Quantiles q = quantiles({5, 1, 2, 4, 3});
  EXPECT_EQ(q.p50, 3);
  EXPECT_EQ(q.lowest, 1);
  EXPECT_EQ(q.highest, 5);
  EXPECT_NEAR(q.mean, 3, 1e-12);
  EXPECT_NEAR(q.deviation, std::sqrt(2.0), 1e-12);
  EXPECT_EQ(quantiles({}).count, 0U);
}

}  // namespace
}  // namespace heel::evaluation
