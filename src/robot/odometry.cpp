#include "robot/odometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/wire_units.h"

namespace heel {
namespace {

using wire::wrapped_difference;

// More than a robot of the family drives with heeld, with a margin for late stamps: a larger step means that
// a counter is wrong or was set to zero.
constexpr double kSpeedMax_m_s = 2.0;
constexpr double kTurnMax_rad_s = 6.0;
constexpr double kDistanceSlack_m = 0.10;
constexpr double kTurnSlack_rad = 0.35;
constexpr double kReachMax_s = 2.5;  // in a longer gap the robot's watchdog has stopped it

// After an interruption, counters this near to zero have been set to zero.
constexpr double kZeroedWithin_m = 0.05;
constexpr double kZeroedWithin_rad = 0.05;

}  // namespace

OdometryTracker::OdometryTracker(const RobotModel& model) {
  set_units(model);
}

void OdometryTracker::set_units(const RobotModel& model) {
  metres_per_unit_ = model.mm_per_position_unit * wire::kMetresPerMm;
  speed_per_unit_m_s_ = model.mm_s_per_speed_unit * wire::kMetresPerMm;
  heading_units_per_turn_ = model.heading_units_per_turn;
  rad_per_heading_unit_ = 2.0 * std::numbers::pi / heading_units_per_turn_;
  effective_track_m_ = model.effective_track_m;
}

void OdometryTracker::use(const RobotModel& model) {
  set_units(model);
  controller_reset();
}

double OdometryTracker::turn_rad(const Counters& from, const Counters& to) const {
  return wrapped_difference(to.heading, from.heading, heading_units_per_turn_) * rad_per_heading_unit_;
}

bool OdometryTracker::reachable(const Counters& from, const Counters& to) const {
  const double elapsed_s = std::clamp(seconds_from_ns(to.t_ns - from.t_ns), 0.0, kReachMax_s);
  const double dx_m = wrapped_difference(to.x, from.x, wire::kPositionUnitsPerWrap) * metres_per_unit_;
  const double dy_m = wrapped_difference(to.y, from.y, wire::kPositionUnitsPerWrap) * metres_per_unit_;
  return std::hypot(dx_m, dy_m) <= kSpeedMax_m_s * elapsed_s + kDistanceSlack_m &&
         std::abs(turn_rad(from, to)) <= kTurnMax_rad_s * elapsed_s + kTurnSlack_rad;
}

bool OdometryTracker::zeroed_meanwhile(const Counters& now) const {
  const auto near_zero = [this](const Counters& c) {
    const Counters zero;
    const double x_m = wrapped_difference(c.x, zero.x, wire::kPositionUnitsPerWrap) * metres_per_unit_;
    const double y_m = wrapped_difference(c.y, zero.y, wire::kPositionUnitsPerWrap) * metres_per_unit_;
    return std::hypot(x_m, y_m) < kZeroedWithin_m && std::abs(turn_rad(zero, c)) < kZeroedWithin_rad;
  };
  return near_zero(now) && !near_zero(last_);
}

void OdometryTracker::anchor(const Counters& at) {
  units_x_ = units_y_ = units_heading_ = 0;
  anchor_x_m_ = pose_.x_m;
  anchor_y_m_ = pose_.y_m;
  anchor_heading_rad_ = pose_.heading_rad;
  const double odom_from_raw_rad = pose_.heading_rad - at.heading * rad_per_heading_unit_;
  cos_odom_from_raw_ = std::cos(odom_from_raw_rad);
  sin_odom_from_raw_ = std::sin(odom_from_raw_rad);
  last_ = at;
}

void OdometryTracker::advance(const Counters& to) {
  units_x_ += wrapped_difference(to.x, last_.x, wire::kPositionUnitsPerWrap);
  units_y_ += wrapped_difference(to.y, last_.y, wire::kPositionUnitsPerWrap);
  units_heading_ += wrapped_difference(to.heading, last_.heading, heading_units_per_turn_);
  last_ = to;
  const double raw_x_m = static_cast<double>(units_x_) * metres_per_unit_;
  const double raw_y_m = static_cast<double>(units_y_) * metres_per_unit_;
  pose_.x_m = anchor_x_m_ + cos_odom_from_raw_ * raw_x_m - sin_odom_from_raw_ * raw_y_m;
  pose_.y_m = anchor_y_m_ + sin_odom_from_raw_ * raw_x_m + cos_odom_from_raw_ * raw_y_m;
  pose_.heading_rad = anchor_heading_rad_ + static_cast<double>(units_heading_) * rad_per_heading_unit_;
}

OdometryTracker::Step OdometryTracker::update(const arcos::Sip& sip, TimeNs t_ns) {
  const Counters now{sip.x_pos, sip.y_pos, sip.th_pos, t_ns};
  const bool confirmed = has_suspect_ && reachable(suspect_, now);
  Step step = Step::Moved;
  if (!started_ || rebase_next_ || (interrupted_ && (zeroed_meanwhile(now) || !reachable(last_, now)))) {
    step = started_ ? Step::Rebased : Step::Moved;
    anchor(now);
  } else if (reachable(last_, now)) {
    advance(now);
  } else if (confirmed) {
    step = Step::Rebased;
    anchor(suspect_);
    advance(now);
  } else {
    suspect_ = now;
    has_suspect_ = true;
    return Step::Suspect;
  }
  started_ = true;
  interrupted_ = rebase_next_ = has_suspect_ = false;

  pose_.t_ns = t_ns;
  const double left_m_s = sip.left_mm_s * speed_per_unit_m_s_;
  const double right_m_s = sip.right_mm_s * speed_per_unit_m_s_;
  pose_.v_m_s = 0.5 * (left_m_s + right_m_s);
  pose_.yaw_rate_rad_s = (right_m_s - left_m_s) / effective_track_m_;
  return step;
}

}  // namespace heel
