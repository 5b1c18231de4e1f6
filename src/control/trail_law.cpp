#include "control/trail_law.h"

#include <algorithm>
#include <cmath>

#include "control/distance_error.h"
#include "control/view_bounds.h"
#include "core/angles.h"
#include "estimate/odometry_history.h"

namespace heel {
namespace {

constexpr double kDamping = 0.9;
constexpr double kBackBehindAxis_m = 0.12;
// Farther from the trail than this the robot has lost it, and begins a new one.
constexpr double kOffTrail_m = 1.5;
// A person who moves slower than half of this stands; one who moves faster walks.
constexpr double kWalks_m_s = 0.16;
constexpr TimeNs kLongestWalk_ns = 500 * kNsPerMs;
// A search ends this far before the place where the person was last seen.
constexpr double kShortOfEnd_m = 0.5;
constexpr double kTurningRoom_m = 0.48;  // from the robot's centre: its corners, 0.40 m, and a margin
// The curvature counts for the speed that the robot will soon have, at most this much more.
constexpr double kAnticipated_m_s = 0.1;
// The estimate of the person's speed has noise of this size; a larger difference is another pace.
constexpr double kPace_m_s = 0.12;
constexpr double kNewPace_s = 0.1;
constexpr double kSamePace_s = 0.6;
constexpr double kTooNearGain = 2.0;
// It looks for a way round an obstacle this far before the gate would brake for it.
constexpr double kNotice_m = 0.1;

/// Zero for a person who stands, `value` for one who walks, continuous between.
double walking_speed(double value) {
  const double share = std::clamp(2.0 * std::abs(value) / kWalks_m_s - 1.0, 0.0, 1.0);
  return share * value;
}

double sinc(double angle) {
  return std::abs(angle) < 1e-6 ? 1.0 : std::sin(angle) / angle;
}

}  // namespace

void TrailLaw::reconfigure(const Config& config) {
  const ControlConfig& control = config.control;
  control_ = {.distance_1_s = control.gain_distance_1_s,
              .deadband_m = control.deadband_distance_m,
              .beside_m = control.setpoint_t_x_m,
              .reverse = control.reverse,
              .bearing_max_rad = control.trail_bearing_rad,
              .bearing_1_s = control.bearing_gain_1_s,
              .reach_m = control.trail_reach_m,
              .smooth_m = control.trail_smooth_m,
              .delay_s = control.trail_delay_s,
              .clearance_m = config.gate.clearance_m,
              .deceleration_m_s2 = config.gate.deceleration_m_s2,
              .v_max_m_s = config.gate.v_max_m_s,
              .search_m_s = control.search_m_s,
              .nearest_m = config.gate.separation_m + config.camera.mount_x_m + kBackBehindAxis_m + 0.05};
  mount_ = mount_of(config.camera);
  detour_.reconfigure(control.detour_m);
  search_.reconfigure(control.search_look_rad, control.search_turn_rad_s);
}

void TrailLaw::reset() {
  trail_.reset();
  detour_.reset();
  search_.end();
  t_capture_ns_ = 0;
  person_m_s_ = 0.0;
}

void TrailLaw::extend_trail(const FollowInput& input, const Pose2& robot) {
  const TargetState& target = input.target;
  if (!target.known || target.t_capture_ns == t_capture_ns_) return;
  t_capture_ns_ = target.t_capture_ns;
  const Eigen::Vector2d body_m(target.body_odom_x_m, target.body_odom_y_m);
  const bool was_single = trail_.empty() || trail_.tip_m() == trail_.first_m();
  const bool same =
      trail_.add(body_m, robot.heading_rad + target.travel_yaw_rad, target.travel_yaw_sigma_rad, robot);
  if (trail_.empty()) return;
  if (!same || was_single)
    robot_s_m_ = trail_.first_m() - std::hypot(body_m.x() - robot.x_m, body_m.y() - robot.y_m);
}

double TrailLaw::left_of_trail_m(const Pose2& robot) const {
  const Trail::Place place = trail_.at(robot_s_m_, control_.smooth_m);
  return std::cos(place.heading_rad) * (robot.y_m - place.y_m) -
         std::sin(place.heading_rad) * (robot.x_m - place.x_m);
}

/// The person's speed without the noise of single frames; a clear change of pace counts at once.
void TrailLaw::update_person_speed(const TargetState& target, double dt_s) {
  const double difference_m_s = target.walk_m_s - person_m_s_;
  if (!std::isfinite(difference_m_s)) return;
  const double memory_s = std::abs(difference_m_s) > kPace_m_s ? kNewPace_s : kSamePace_s;
  person_m_s_ += (1.0 - std::exp(-dt_s / memory_s)) * difference_m_s;
}

/// Along the trail.
double TrailLaw::speed_m_s(const FollowInput& input) const {
  const TargetState& target = input.target;
  const double person_m_s = walking_speed(person_m_s_);
  const double since_s =
      seconds_from_ns(std::clamp<TimeNs>(input.now_ns - target.t_capture_ns, 0, kLongestWalk_ns));
  const double set_m = distance_behind_m(target, target.travel_yaw_rad) + kBackBehindAxis_m;
  const double person_s_m = trail_.tip_m() + person_m_s * (since_s + control_.delay_s);
  const double error_m = person_s_m - robot_s_m_ - set_m;
  const double band_m = control_.deadband_m * (1.0 - std::min(1.0, std::abs(person_m_s) / kWalks_m_s));
  const double beyond_m = with_deadband(error_m, band_m);
  // It gives way sooner than it catches up.
  const double gain_1_s = (beyond_m < 0.0 ? kTooNearGain : 1.0) * control_.distance_1_s;
  const double v_m_s = gain_1_s > 0.0 ? person_m_s + gain_1_s * beyond_m : 0.0;
  const double least_m_s = control_.reverse ? -control_.v_max_m_s : 0.0;
  return std::clamp(v_m_s, least_m_s, control_.v_max_m_s);
}

/// Samson's law towards the line `offset_m` beside the trail.
double TrailLaw::yaw_rate_rad_s(const Pose2& robot, double v_m_s, double offset_m) const {
  const Trail::Place place = trail_.at(robot_s_m_, control_.smooth_m);
  const double e_m = left_of_trail_m(robot) - offset_m;
  const double theta_rad = wrap_angle_rad(robot.heading_rad - place.heading_rad);
  const double reach_m = control_.reach_m;
  // Far from the trail the robot drives towards it at a fixed angle.
  const double pull_m = std::clamp(e_m, -1.2 * reach_m, 1.2 * reach_m);
  const double inner = std::max(1.0 - place.curvature_1_m * e_m, 0.3);
  return v_m_s * place.curvature_1_m * std::cos(theta_rad) / inner -
         v_m_s * pull_m * sinc(theta_rad) / (reach_m * reach_m) -
         2.0 * kDamping * std::abs(v_m_s) * theta_rad / reach_m;
}

WantedVelocity TrailLaw::velocity(const FollowInput& input) {
  const Odometry& odometry = input.robot.odometry;
  const double age_s = std::clamp(seconds_from_ns(input.now_ns - odometry.t_ns), 0.0, 0.5);
  const Pose2 now = extrapolated(odometry, age_s);
  // While it searches, a single frame is no evidence of where the person is: the trail stays as it was.
  if (!input.searching) extend_trail(input, now);
  if (trail_.empty()) return {0.0, 0.0, input.searching};
  const Pose2 robot = extrapolated(odometry, age_s + control_.delay_s);
  robot_s_m_ =
      std::min(trail_.nearest_m(robot.x_m, robot.y_m, robot_s_m_, control_.smooth_m), trail_.tip_m());
  if (!std::isfinite(robot_s_m_)) {  // from odometry that is not: it would stay
    reset();
    return {0.0, 0.0, input.searching};
  }
  if (input.searching) return search(input, robot);
  search_.end();
  if (!input.target.known) return {};
  if (std::abs(left_of_trail_m(robot)) > kOffTrail_m) {
    trail_.reset();
    return {};
  }
  update_person_speed(input.target, std::clamp(seconds_from_ns(input.now_ns - t_last_ns_), 0.0, 0.1));
  t_last_ns_ = input.now_ns;
  const double v_m_s = speed_m_s(input);
  const double driven_m_s =
      odometry.v_m_s + std::clamp(v_m_s - odometry.v_m_s, -kAnticipated_m_s, kAnticipated_m_s);
  const double on_trail_rad_s = yaw_rate_rad_s(robot, driven_m_s, control_.beside_m);
  const bool blocked =
      v_m_s > 0.0 && input.obstacles.way(v_m_s, on_trail_rad_s, control_.clearance_m).room_m <
                         v_m_s * v_m_s / control_.deceleration_m_s2 + kNotice_m;
  const double offset_m =
      control_.beside_m + detour_.offset_m(trail_, robot_s_m_, now, input.obstacles, blocked, input.now_ns);
  const YawRateBounds bounds =
      view_bounds(input.target, mount_, v_m_s, {person_m_s_, walking_speed(input.target.aside_m_s)},
                  control_.bearing_max_rad, control_.bearing_1_s);
  const double yaw_rate = yaw_rate_rad_s(robot, driven_m_s, offset_m);
  return {v_m_s, std::clamp(yaw_rate, bounds.least_rad_s, bounds.most_rad_s)};
}

WantedVelocity TrailLaw::search(const FollowInput& input, const Pose2& robot) {
  if (!search_.running()) {
    detour_.reset();
    const TargetState& target = input.target;
    const bool turning = std::abs(target.walk_turn_rad_s) > target.walk_turn_sigma_rad_s;
    search_.begin(trail_.at(trail_.last_m(), control_.smooth_m).heading_rad,
                  turning ? target.walk_turn_rad_s : target.y_m);
  }
  if (search_.done()) return {0.0, 0.0, true};
  const double left_m = trail_.tip_m() - std::max(kShortOfEnd_m, control_.nearest_m) - robot_s_m_;
  if (left_m > 0.0) {
    const double v_m_s = std::min(control_.search_m_s, control_.distance_1_s * left_m + 0.03);
    return {v_m_s, yaw_rate_rad_s(robot, v_m_s, control_.beside_m)};
  }
  // The gate does not see what the corners of a turning robot would hit.
  const auto points = input.obstacles.points();
  const bool narrow = std::any_of(points.begin(), points.end(), [](const ObstaclePoint& point) {
    return std::hypot(point.x_m, point.y_m) < kTurningRoom_m;
  });
  if (narrow) return {0.0, 0.0, true};
  return {0.0, search_.yaw_rate_rad_s(robot.heading_rad, input.now_ns)};
}

}  // namespace heel
