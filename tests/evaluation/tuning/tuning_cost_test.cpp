// The cost of a run: 1 when it just reaches every aim, more for each failure than any figure can give.
#include "evaluation/tuning/tuning_cost.h"

#include <gtest/gtest.h>

namespace heel::evaluation {
namespace {

FollowMetrics at_every_aim() {
  FollowMetrics metrics;
  metrics.following.path_p95_m = 0.05;
  metrics.following.along_p95_m = 0.15;
  metrics.following.jerk_p99_m_s3 = 3.0;
  metrics.following.straight_yaw_rate_rms_rad_s = 0.015;
  metrics.following.yaw_within_share = 0.99;
  metrics.following.out_of_sight_share = 0.01;
  metrics.following.followed_to_end = true;
  return metrics;
}

TEST(TuningCost, IsOneAtEveryAim) {
  EXPECT_NEAR(cost_of(at_every_aim()), 1.0, 1e-9);
}

TEST(TuningCost, RisesWithEachFigure) {
  const double least = cost_of(at_every_aim());
  FollowMetrics worse = at_every_aim();
  worse.following.path_p95_m *= 2.0;
  EXPECT_NEAR(cost_of(worse) - least, 1.0 / static_cast<double>(cost_terms().size()), 1e-9);
  worse = at_every_aim();
  worse.following.yaw_within_share = 0.9;
  EXPECT_GT(cost_of(worse), least + 0.5);
}

TEST(TuningCost, AFailureCostsMoreThanAnyFigure) {
  const double least = cost_of(at_every_aim());
  FollowMetrics failed = at_every_aim();
  failed.following.contacts = 1;
  EXPECT_NEAR(cost_of(failed), least + kFailureCost, 1e-9);
  failed.following.followed_to_end = false;
  failed.following.separation_entries = 1;
  EXPECT_NEAR(cost_of(failed), least + 3.0 * kFailureCost, 1e-9);
}

}  // namespace
}  // namespace heel::evaluation
