#include "evaluation/tuning/tuning_cost.h"

#include <array>

namespace heel::evaluation {
namespace {

constexpr std::array kCostTerms{
    CostTerm{"path_p95_m", "m", 0.05, [](const FollowMetrics& m) { return m.following.path_p95_m; }},
    CostTerm{"along_p95_m", "m", 0.15, [](const FollowMetrics& m) { return m.following.along_p95_m; }},
    CostTerm{"jerk_p99_m_s3", "m/s³", 3.0, [](const FollowMetrics& m) { return m.following.jerk_p99_m_s3; }},
    CostTerm{"straight_yaw_rate_rms_rad_s", "rad/s", 0.015,
             [](const FollowMetrics& m) { return m.following.straight_yaw_rate_rms_rad_s; }},
    CostTerm{"yaw_beyond_share", "", 0.01,
             [](const FollowMetrics& m) { return 1.0 - m.following.yaw_within_share; }},
    CostTerm{"out_of_sight_share", "", 0.01,
             [](const FollowMetrics& m) { return m.following.out_of_sight_share; }},
};

}  // namespace

std::span<const CostTerm> cost_terms() {
  return kCostTerms;
}

double cost_of(const FollowMetrics& metrics) {
  double sum = 0.0;
  for (const CostTerm& term : kCostTerms) sum += term.value(metrics) / term.aim;
  const int failures = metrics.following.contacts + metrics.following.separation_entries +
                       (metrics.following.followed_to_end ? 0 : 1);
  return sum / static_cast<double>(kCostTerms.size()) + kFailureCost * failures;
}

}  // namespace heel::evaluation
