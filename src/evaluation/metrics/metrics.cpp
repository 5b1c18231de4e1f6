#include "evaluation/metrics/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angles.h"
#include "heel/flow.h"

namespace heel::evaluation {
namespace {

const std::string kFollowing = to_string(StopReason::None);
const std::string kShuttingDown = to_string(StopReason::Shutdown);
constexpr double kWalking_m_s = 0.05;
constexpr double kMaxLateral_m = 100.0;  ///< reported when the path is farther away
constexpr std::size_t kSearchBehind = 100;
constexpr std::size_t kSearchAhead = 300;

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

double length_m(const std::vector<Pose2>& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum += std::hypot(path[i].x_m - path[i - 1].x_m, path[i].y_m - path[i - 1].y_m);
  return sum;
}

void find_walk(const std::vector<MotionSample>& motion, FollowMetrics& out) {
  bool found = false;
  for (const MotionSample& sample : motion) {
    if (!sample.has_person || sample.person_speed_m_s < kWalking_m_s) continue;
    if (!found) out.t_walk_begin_s = sample.t_s;
    out.t_walk_end_s = sample.t_s;
    found = true;
  }
  if (!found && !motion.empty()) {
    out.t_walk_begin_s = motion.front().t_s;
    out.t_walk_end_s = motion.back().t_s;
  }
}

void measure_paths(const std::vector<MotionSample>& motion, FollowMetrics& out) {
  const std::vector<Pose2> path = person_path(motion);
  std::vector<Pose2> robot_path;
  std::vector<double> lateral, separation;
  std::size_t near = 0;
  double t_out_since_s = -1.0;
  double t_before_s = out.t_walk_begin_s;
  for (const MotionSample& sample : motion) {
    if (sample.t_s < out.t_walk_begin_s) continue;
    if (sample.touching) out.touching_s += sample.t_s - t_before_s;
    t_before_s = sample.t_s;
    // The pose of a standing robot still trembles: only steps of a centimetre count.
    if (robot_path.empty() ||
        std::hypot(sample.robot.x_m - robot_path.back().x_m, sample.robot.y_m - robot_path.back().y_m) > 0.01)
      robot_path.push_back(sample.robot);
    if (!sample.has_person) continue;
    if (path.size() > 1) lateral.push_back(lateral_distance_m(path, sample.robot, near));
    separation.push_back(
        std::hypot(sample.robot.x_m - sample.person.x_m, sample.robot.y_m - sample.person.y_m));
    if (sample.t_s <= out.t_walk_end_s) out.separation_end_m = separation.back();
    if (sample.back_in_view)
      t_out_since_s = -1.0;
    else if (t_out_since_s < 0.0)
      t_out_since_s = sample.t_s;
    if (t_out_since_s >= 0.0)
      out.truly_out_of_view_longest_s = std::max(out.truly_out_of_view_longest_s, sample.t_s - t_out_since_s);
  }
  out.person_path_m = length_m(path);
  out.robot_path_m = length_m(robot_path);
  out.lateral_m = quantiles(lateral);
  out.separation_m = quantiles(separation);
}

void measure_poses(const std::vector<PoseSample>& poses, FollowMetrics& out) {
  std::vector<double> certainty, yaw, x, y, z;
  double nees = 0.0;
  double t_found_s = out.t_walk_begin_s;
  double t_last_s = out.t_walk_begin_s;
  for (const PoseSample& pose : poses) {
    if (pose.t_s < out.t_walk_begin_s || pose.t_s > out.t_walk_end_s) continue;
    ++out.frames;
    if (!pose.found) out.out_of_view_total_s += pose.t_s - t_last_s;
    t_last_s = pose.t_s;
    certainty.push_back(pose.found ? pose.certainty : 0.0);
    if (!pose.found) continue;
    ++out.frames_found;
    out.out_of_view_longest_s = std::max(out.out_of_view_longest_s, pose.t_s - t_found_s);
    t_found_s = pose.t_s;
    if (!pose.has_truth) continue;
    yaw.push_back(wrap_angle_rad(pose.yaw_rad - pose.true_yaw_rad));
    x.push_back(pose.x_m - pose.true_x_m);
    y.push_back(pose.y_m - pose.true_y_m);
    z.push_back(pose.z_m - pose.true_z_m);
    if (std::hypot(x.back(), y.back(), z.back()) > kWrong_m) ++out.frames_wrong;
    if (pose.yaw_sigma_rad > 0.0) nees += std::pow(yaw.back() / pose.yaw_sigma_rad, 2);
  }
  out.out_of_view_longest_s = std::max(out.out_of_view_longest_s, t_last_s - t_found_s);
  out.certainty = quantiles(certainty);
  out.yaw_error_rad = quantiles(yaw);
  out.x_error_m = quantiles(x);
  out.y_error_m = quantiles(y);
  out.z_error_m = quantiles(z);
  if (!yaw.empty()) out.yaw_nees = nees / static_cast<double>(yaw.size());
}

void count_stops(const std::vector<TickSample>& ticks, FollowMetrics& out) {
  std::string before = kFollowing;
  double t_before_s = out.t_walk_begin_s;
  for (const TickSample& tick : ticks) {
    if (tick.t_s < out.t_walk_begin_s || tick.t_s > out.t_walk_end_s) continue;
    // The end of the run is no failure to follow.
    if (tick.stop_reason == kShuttingDown) break;
    if (tick.stop_reason != kFollowing) {
      out.rest_s_by_reason[tick.stop_reason] += tick.t_s - t_before_s;
      if (before == kFollowing) ++out.stops_by_reason[tick.stop_reason];
    }
    before = tick.stop_reason;
    t_before_s = tick.t_s;
  }
}

nlohmann::ordered_json to_json(const Quantiles& q) {
  return {{"count", q.count}, {"mean", q.mean},  {"deviation", q.deviation},
          {"rms", q.rms},     {"min", q.lowest}, {"p05", q.p05},
          {"p50", q.p50},     {"p95", q.p95},    {"max", q.highest}};
}

double nearest_rank(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

}  // namespace

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

double lateral_distance_m(const std::vector<Pose2>& path, const Pose2& point, std::size_t& near) {
  const std::size_t from = near > kSearchBehind ? near - kSearchBehind : 0;
  const std::size_t to = std::min(path.size() - 1, near + kSearchAhead);
  double best2 = kMaxLateral_m * kMaxLateral_m;
  double lateral = kMaxLateral_m;
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
    lateral = std::copysign(std::sqrt(distance2), ex * dy - ey * dx);
    near = i;
  }
  return lateral;
}

FollowMetrics MetricsCollector::evaluate() const {
  FollowMetrics out;
  find_walk(motion_, out);
  measure_paths(motion_, out);
  measure_poses(poses_, out);
  count_stops(ticks_, out);
  return out;
}

nlohmann::ordered_json to_json(const FollowMetrics& m) {
  nlohmann::ordered_json json;
  json["walk_s"] = {m.t_walk_begin_s, m.t_walk_end_s};
  json["person_path_m"] = m.person_path_m;
  json["robot_path_m"] = m.robot_path_m;
  json["following_rms_m"] = m.lateral_m.rms;
  json["following_max_m"] = std::max(std::abs(m.lateral_m.lowest), std::abs(m.lateral_m.highest));
  json["lateral_m"] = to_json(m.lateral_m);
  json["separation_m"] = to_json(m.separation_m);
  json["frames"] = m.frames;
  json["frames_found"] = m.frames_found;
  json["out_of_view_longest_s"] = m.out_of_view_longest_s;
  json["out_of_view_total_s"] = m.out_of_view_total_s;
  json["truly_out_of_view_longest_s"] = m.truly_out_of_view_longest_s;
  json["certainty"] = to_json(m.certainty);
  json["yaw_error_rad"] = to_json(m.yaw_error_rad);
  json["yaw_nees"] = m.yaw_nees;
  json["x_error_m"] = to_json(m.x_error_m);
  json["y_error_m"] = to_json(m.y_error_m);
  json["z_error_m"] = to_json(m.z_error_m);
  json["stops_by_reason"] = m.stops_by_reason;
  json["rest_s_by_reason"] = m.rest_s_by_reason;
  json["touching_s"] = m.touching_s;
  json["frames_wrong"] = m.frames_wrong;
  json["separation_end_m"] = m.separation_end_m;
  return json;
}

std::vector<std::string> failed_criteria(const FollowMetrics& m, const FollowCriteria& criteria) {
  std::vector<std::string> failed;
  if (m.frames == 0) failed.push_back("no frame was seen while the person walked");
  if (criteria.max_out_of_view_s >= 0.0 && m.out_of_view_longest_s > criteria.max_out_of_view_s)
    failed.push_back(fmt::format("the target was out of view for {:.2f} s (at most {:.2f} s allowed)",
                                 m.out_of_view_longest_s, criteria.max_out_of_view_s));
  if (criteria.max_rms_m >= 0.0 && (m.lateral_m.count == 0 || !(m.lateral_m.rms <= criteria.max_rms_m)))
    failed.push_back(
        fmt::format("the robot's path was {:.3f} m RMS beside the person's (at most {:.3f} m allowed)",
                    m.lateral_m.rms, criteria.max_rms_m));
  if (criteria.min_robot_path_m >= 0.0 && m.robot_path_m < criteria.min_robot_path_m)
    failed.push_back(fmt::format("the robot went {:.2f} m (at least {:.2f} m expected)", m.robot_path_m,
                                 criteria.min_robot_path_m));
  return failed;
}

}  // namespace heel::evaluation
