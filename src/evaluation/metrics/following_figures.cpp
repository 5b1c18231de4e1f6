#include "evaluation/metrics/following_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "heel/flow.h"

namespace heel::evaluation {
namespace {

constexpr double kBehindRobot_m = 1.0;  // a straight part includes this much of the path behind the robot
constexpr double kStraight_rad = 1.0 * kRadPerDeg;
constexpr double kAlongHeading_rad = 10.0 * kRadPerDeg;  // a step aside is no straight part
constexpr double kWalkingOn_m_s = 0.3;

/// The person's path with its length at each point. Steps backwards count negative, so that the distance
/// along the path to a person who comes back decreases.
struct MeasuredPath {
  std::vector<Pose2> points;
  std::vector<double> s_m;
  std::vector<bool> ahead;  ///< the segment from this point goes where the person faces

  explicit MeasuredPath(const std::vector<MotionSample>& motion) : points(person_path(motion)) {
    double s = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      s_m.push_back(s);
      if (i + 1 == points.size()) break;
      const double dx = points[i + 1].x_m - points[i].x_m, dy = points[i + 1].y_m - points[i].y_m;
      const double off_rad = std::abs(wrap_angle_rad(std::atan2(dy, dx) - points[i].heading_rad));
      ahead.push_back(off_rad < kAlongHeading_rad);
      s += std::copysign(std::hypot(dx, dy), off_rad < 0.75 * std::numbers::pi ? 1.0 : -1.0);
    }
    ahead.push_back(true);
  }
  double length_at_m(const PathPlace& place) const {
    return s_m[place.segment] + place.share * (s_m[place.segment + 1] - s_m[place.segment]);
  }
  /// Straight between the two points.
  bool straight(std::size_t from, std::size_t to) const {
    for (std::size_t i = from; i <= to; ++i)
      if (!ahead[i] ||
          std::abs(wrap_angle_rad(points[i].heading_rad - points[from].heading_rad)) > kStraight_rad)
        return false;
    return true;
  }
};

double mean_back_offset_m(const std::vector<MotionSample>& motion, const WalkTimes& walk) {
  double sum = 0.0;
  int count = 0;
  for (const MotionSample& sample : motion) {
    if (!sample.has_back || sample.t_s < walk.begin_s || sample.t_s > walk.end_s) continue;
    sum += std::cos(sample.person.heading_rad) * (sample.person.x_m - sample.back_x_m) +
           std::sin(sample.person.heading_rad) * (sample.person.y_m - sample.back_y_m);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

double share(std::size_t part, std::size_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

double absolute_p95(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return quantile(std::move(values), 0.95);
}

/// Times, in order, at which the robot drives on a straight part of the path.
std::vector<double> measure_path(const std::vector<MotionSample>& motion, const WalkTimes& walk,
                                 const FollowReference& reference, FollowingFigures& out) {
  std::vector<double> straight_times_s;
  const MeasuredPath path(motion);
  if (path.points.size() < 2) return straight_times_s;
  const double offset_m = mean_back_offset_m(motion, walk);
  std::vector<double> beside, along;
  std::size_t near = 0, person = 0, within = 0;
  for (const MotionSample& sample : motion) {
    if (!sample.has_person) continue;
    const auto to_person = [&](std::size_t i) {
      return std::hypot(sample.person.x_m - path.points[i].x_m, sample.person.y_m - path.points[i].y_m);
    };
    while (person + 1 < path.points.size() && to_person(person + 1) <= to_person(person)) ++person;
    if (sample.t_s < walk.begin_s || sample.t_s > walk.end_s) continue;
    const PathPlace place = place_on_path(path.points, sample.robot, near);
    near = place.segment;
    beside.push_back(std::abs(place.lateral_m));
    const double robot_s_m = path.length_at_m(place);
    if (reference.set_distance_m > 0.0 && sample.has_back) {
      along.push_back(path.s_m[person] - robot_s_m - offset_m - reference.set_distance_m);
      if (std::abs(along.back()) <= kAlongBand_m) ++within;
    }
    std::size_t from = near;
    while (from > 0 && robot_s_m - path.s_m[from] < kBehindRobot_m) --from;
    if (robot_s_m - path.s_m[from] >= kBehindRobot_m && sample.person_speed_m_s >= kWalkingOn_m_s &&
        person > from && path.straight(from, person - 1))
      straight_times_s.push_back(sample.t_s);
  }
  out.path_p95_m = quantile(beside, 0.95);
  out.path_max_m = quantile(beside, 1.0);
  out.along_error_m = quantiles(along);
  out.along_p95_m = absolute_p95(along);
  out.along_within_share = share(within, along.size());
  out.along_end_m = along.empty() ? 0.0 : along.back();
  return straight_times_s;
}

/// How the robot came to the path from beside it.
void measure_step(const std::vector<MotionSample>& motion, const WalkTimes& walk, FollowingFigures& out) {
  constexpr double kMoved_m = 0.01;
  const std::vector<Pose2> path = person_path(motion);
  if (path.size() < 2) return;
  std::size_t near = 0;
  const double first_m = place_on_path(path, motion.front().robot, 0).lateral_m;
  out.has_step = std::abs(first_m) >= kStep_m;
  if (!out.has_step) return;
  double t_moved_s = -1.0, t_off_s = -1.0, beyond_m = 0.0;
  for (const MotionSample& sample : motion) {
    if (sample.t_s > walk.end_s) break;
    const PathPlace place = place_on_path(path, sample.robot, near);
    near = place.segment;
    if (t_moved_s < 0.0 && std::hypot(sample.robot.x_m - motion.front().robot.x_m,
                                      sample.robot.y_m - motion.front().robot.y_m) < kMoved_m)
      continue;
    if (t_moved_s < 0.0) t_moved_s = sample.t_s;
    const Pose2 &a = path[near], &b = path[near + 1];
    const double off_rad =
        wrap_angle_rad(sample.robot.heading_rad - std::atan2(b.y_m - a.y_m, b.x_m - a.x_m));
    if (std::abs(place.lateral_m) > kSettled_m || std::abs(off_rad) > kSettled_rad) t_off_s = sample.t_s;
    beyond_m = std::max(beyond_m, -std::copysign(1.0, first_m) * place.lateral_m);
  }
  out.settled_s = std::max(t_off_s - t_moved_s, 0.0);
  out.settled_walking_s = std::max(t_off_s - std::max(t_moved_s, walk.begin_s), 0.0);
  out.overshoot_share = beyond_m / std::abs(first_m);
}

/// Of the bumper's end that is faster.
double bumper_speed_m_s(const MotionSample& sample) {
  constexpr double kBumper_m = 0.31, kHalfWidth_m = 0.25;
  const double turns_rad_s = std::abs(sample.robot_yaw_rate_rad_s);
  return std::hypot(std::abs(sample.robot_v_m_s) + kHalfWidth_m * turns_rad_s, kBumper_m * turns_rad_s);
}

void measure_view(const std::vector<MotionSample>& motion, const WalkTimes& walk,
                  const FollowReference& reference, FollowingFigures& out) {
  std::size_t all = 0, within = 0, out_of_sight = 0;
  bool near_before = false, touching_before = false;
  for (const MotionSample& sample : motion) {
    if (sample.t_s < walk.begin_s || sample.t_s > walk.end_s) continue;
    if (sample.touching && !touching_before) {
      const double speed_m_s = bumper_speed_m_s(sample);
      ++out.contacts;
      if (speed_m_s < kAtRest_m_s) ++out.contacts_at_rest;
      out.contact_m_s = std::max(out.contact_m_s, speed_m_s);
    }
    touching_before = sample.touching;
    if (!sample.has_back) continue;
    ++all;
    if (std::abs(sample.back_yaw_rad) <= kYawBand_rad) ++within;
    if (!sample.back_in_view && !sample.back_hidden) ++out_of_sight;
    const double c = std::cos(sample.robot.heading_rad), s = std::sin(sample.robot.heading_rad);
    const double camera_x_m = sample.robot.x_m + c * reference.camera_x_m - s * reference.camera_y_m;
    const double camera_y_m = sample.robot.y_m + s * reference.camera_x_m + c * reference.camera_y_m;
    const bool near =
        std::hypot(sample.back_x_m - camera_x_m, sample.back_y_m - camera_y_m) < reference.separation_m;
    if (near && !near_before) ++out.separation_entries;
    near_before = near;
  }
  out.yaw_within_share = share(within, all);
  out.out_of_sight_share = share(out_of_sight, all);
}

void measure_found_again(const std::vector<MotionSample>& motion, const std::vector<PoseSample>& poses,
                         const WalkTimes& walk, FollowingFigures& out) {
  std::vector<double> times_s;
  double t_hidden_s = -1.0;
  std::size_t pose = 0;
  for (const MotionSample& sample : motion) {
    if (!sample.has_person || sample.t_s < walk.begin_s || sample.t_s > walk.end_s) continue;
    if (!sample.back_in_view) {
      if (t_hidden_s < 0.0) t_hidden_s = sample.t_s;
      continue;
    }
    const bool again = t_hidden_s >= 0.0 && sample.t_s - t_hidden_s >= kHidden_s;
    t_hidden_s = -1.0;
    if (!again) continue;
    while (pose < poses.size() && (poses[pose].t_s < sample.t_s || !poses[pose].found)) ++pose;
    const double t_found_s = pose < poses.size() ? poses[pose].t_s : walk.end_s;
    times_s.push_back(std::max(0.0, t_found_s - sample.t_s));
  }
  out.found_again_s = quantiles(times_s);
}

void measure_commands(const std::vector<TickSample>& ticks, const WalkTimes& walk,
                      const std::vector<double>& straight_times_s, FollowingFigures& out) {
  std::vector<double> jerk;
  double squares = 0.0;
  std::size_t straight = 0;
  for (std::size_t i = 2; i < ticks.size(); ++i) {
    const TickSample &a = ticks[i - 2], &b = ticks[i - 1], &c = ticks[i];
    if (c.t_s < walk.begin_s || c.t_s > walk.end_s) continue;
    const double dt_s = 0.5 * (c.t_s - a.t_s);
    if (dt_s > 0.0) jerk.push_back(std::abs(c.v_m_s - 2.0 * b.v_m_s + a.v_m_s) / (dt_s * dt_s));
    const auto at = std::lower_bound(straight_times_s.begin(), straight_times_s.end(), c.t_s - 0.5 * dt_s);
    if (at == straight_times_s.end() || *at > c.t_s + 0.5 * dt_s) continue;
    squares += c.yaw_rate_rad_s * c.yaw_rate_rad_s;
    out.straight_s += dt_s;
    ++straight;
  }
  out.jerk_p99_m_s3 = quantile(jerk, 0.99);
  if (straight > 0) out.straight_yaw_rate_rms_rad_s = std::sqrt(squares / static_cast<double>(straight));
}

}  // namespace

FollowingFigures following_figures(const std::vector<MotionSample>& motion,
                                   const std::vector<PoseSample>& poses, const std::vector<TickSample>& ticks,
                                   const FollowReference& reference) {
  FollowingFigures out;
  const WalkTimes walk = walk_times(motion);
  const std::vector<double> straight_times_s = measure_path(motion, walk, reference, out);
  measure_step(motion, walk, out);
  measure_view(motion, walk, reference, out);
  measure_found_again(motion, poses, walk, out);
  measure_commands(ticks, walk, straight_times_s, out);
  const std::string following = to_string(StopReason::None);
  const auto last = std::find_if(ticks.rbegin(), ticks.rend(),
                                 [&](const TickSample& tick) { return tick.t_s <= walk.end_s; });
  out.followed_to_end = last != ticks.rend() && last->stop_reason == following &&
                        out.along_error_m.count > 0 && out.along_end_m <= kLeftBehind_m;
  return out;
}

nlohmann::ordered_json to_json(const FollowingFigures& f) {
  return {{"path_p95_m", f.path_p95_m},
          {"path_max_m", f.path_max_m},
          {"along_error_m", to_json(f.along_error_m)},
          {"along_p95_m", f.along_p95_m},
          {"along_end_m", f.along_end_m},
          {"along_within_share", f.along_within_share},
          {"separation_entries", f.separation_entries},
          {"jerk_p99_m_s3", f.jerk_p99_m_s3},
          {"straight_s", f.straight_s},
          {"straight_yaw_rate_rms_rad_s", f.straight_yaw_rate_rms_rad_s},
          {"yaw_within_share", f.yaw_within_share},
          {"out_of_sight_share", f.out_of_sight_share},
          {"found_again_s", to_json(f.found_again_s)},
          {"has_step", f.has_step},
          {"settled_s", f.settled_s},
          {"settled_walking_s", f.settled_walking_s},
          {"overshoot_share", f.overshoot_share},
          {"contacts", f.contacts},
          {"contacts_at_rest", f.contacts_at_rest},
          {"contact_m_s", f.contact_m_s},
          {"followed_to_end", f.followed_to_end}};
}

}  // namespace heel::evaluation
