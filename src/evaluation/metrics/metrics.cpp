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

double length_m(const std::vector<Pose2>& path) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    sum += std::hypot(path[i].x_m - path[i - 1].x_m, path[i].y_m - path[i - 1].y_m);
  return sum;
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
    if (path.size() > 1) {
      const PathPlace place = place_on_path(path, sample.robot, near);
      near = place.segment;
      lateral.push_back(place.lateral_m);
    }
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

}  // namespace

FollowMetrics MetricsCollector::evaluate() const {
  FollowMetrics out;
  const WalkTimes walk = walk_times(motion_);
  out.t_walk_begin_s = walk.begin_s;
  out.t_walk_end_s = walk.end_s;
  measure_paths(motion_, out);
  measure_poses(poses_, out);
  count_stops(ticks_, out);
  out.following = following_figures(motion_, poses_, ticks_, reference_);
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
  json["following"] = to_json(m.following);
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
