#include "evaluation/metrics/samples.h"

#include <algorithm>
#include <cmath>

namespace heel::evaluation {
namespace {

constexpr double kWalking_m_s = 0.05;
constexpr double kMaxLateral_m = 100.0;  ///< reported when the path is farther away
constexpr std::size_t kSearchBehind = 100;
constexpr std::size_t kSearchAhead = 300;

double nearest_rank(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

}  // namespace

std::vector<Pose2> person_path(const std::vector<MotionSample>& motion) {
  std::vector<Pose2> path;
  for (const MotionSample& sample : motion) {
    if (!sample.has_person) continue;
    // A standing person adds nothing to the path.
    if (!path.empty() &&
        std::hypot(sample.person.x_m - path.back().x_m, sample.person.y_m - path.back().y_m) < 0.01)
      continue;
    path.push_back(sample.person);
  }
  return path;
}

WalkTimes walk_times(const std::vector<MotionSample>& motion) {
  WalkTimes walk;
  bool found = false;
  for (const MotionSample& sample : motion) {
    if (!sample.has_person || sample.person_speed_m_s < kWalking_m_s) continue;
    if (!found) walk.begin_s = sample.t_s;
    walk.end_s = sample.t_s;
    found = true;
  }
  if (!found && !motion.empty()) walk = {motion.front().t_s, motion.back().t_s};
  return walk;
}

nlohmann::ordered_json to_json(const Quantiles& q) {
  return {{"count", q.count}, {"mean", q.mean},  {"deviation", q.deviation},
          {"rms", q.rms},     {"min", q.lowest}, {"p05", q.p05},
          {"p50", q.p50},     {"p95", q.p95},    {"max", q.highest}};
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return nearest_rank(values, share);
}

Quantiles quantiles(std::vector<double> values) {
  Quantiles q;
  q.count = values.size();
  if (values.empty()) return q;
  std::sort(values.begin(), values.end());
  double sum = 0.0, squares = 0.0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto n = static_cast<double>(values.size());
  q.mean = sum / n;
  q.rms = std::sqrt(squares / n);
  q.deviation = std::sqrt(std::max(0.0, squares / n - q.mean * q.mean));
  q.p05 = nearest_rank(values, 0.05);
  q.p50 = nearest_rank(values, 0.5);
  q.p95 = nearest_rank(values, 0.95);
  q.lowest = values.front();
  q.highest = values.back();
  return q;
}

PathPlace place_on_path(const std::vector<Pose2>& path, const Pose2& point, std::size_t near) {
  const std::size_t from = near > kSearchBehind ? near - kSearchBehind : 0;
  const std::size_t to = std::min(path.size() - 1, near + kSearchAhead);
  double best2 = kMaxLateral_m * kMaxLateral_m;
  PathPlace place{kMaxLateral_m, near, 0.0};
  for (std::size_t i = from; i < to; ++i) {
    const Pose2& a = path[i];
    const double ex = path[i + 1].x_m - a.x_m;
    const double ey = path[i + 1].y_m - a.y_m;
    const double length2 = std::max(ex * ex + ey * ey, 1e-18);
    double along = ((point.x_m - a.x_m) * ex + (point.y_m - a.y_m) * ey) / length2;
    // The path is extended backwards: the robot starts behind the person.
    along = std::clamp(along, i == 0 ? -1e9 : 0.0, 1.0);
    const double dx = point.x_m - a.x_m - along * ex;
    const double dy = point.y_m - a.y_m - along * ey;
    const double distance2 = dx * dx + dy * dy;
    if (distance2 >= best2) continue;
    best2 = distance2;
    place = {std::copysign(std::sqrt(distance2), ex * dy - ey * dx), i, along};
  }
  return place;
}

}  // namespace heel::evaluation
