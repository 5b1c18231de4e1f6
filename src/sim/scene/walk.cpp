#include "sim/scene/walk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "heel/error.h"

namespace heel::sim {
namespace {

constexpr double kStep_s = 0.01;
constexpr double kAcceleration_m_s2 = 0.6;

constexpr double kSittingDown_s = 1.4;  ///< the same time for standing up

/// The state after `length_m` of a leg that begins at `from`.
WalkState after(const WalkState& from, double length_m, double curvature_1_m, double travel_rad) {
  WalkState to = from;
  const double turn = length_m * curvature_1_m;
  if (std::abs(curvature_1_m) < 1e-12) {
    to.x_m += length_m * std::cos(from.heading_rad + travel_rad);
    to.y_m += length_m * std::sin(from.heading_rad + travel_rad);
  } else {
    const double radius = 1.0 / curvature_1_m;
    to.x_m += radius * (std::sin(from.heading_rad + turn) - std::sin(from.heading_rad));
    to.y_m -= radius * (std::cos(from.heading_rad + turn) - std::cos(from.heading_rad));
  }
  to.heading_rad += turn;
  return to;
}

/// From 0 to 1 with zero slope at both ends.
double smooth(double share) {
  return 0.5 - 0.5 * std::cos(std::numbers::pi * share);
}

/// The step rate grows with the speed, from about one step a second.
double stride_rate_rad_s(double speed_m_s) {
  if (speed_m_s < 0.02) return 0.0;
  const double steps_per_s = 0.9 + 0.75 * speed_m_s;
  return std::numbers::pi * steps_per_s;
}

}  // namespace

/// A part of the walk with constant curvature and target speed, or a stop.
struct Walk::Leg {
  double length_m = 0.0;
  double curvature_1_m = 0.0;
  double speed_m_s = 0.0;
  double wait_s = 0.0;
  double turn_rad = 0.0;
  double travel_rad = 0.0;
  bool sits = false;
  bool moving() const { return length_m > 0.0; }
};

/// Adds an arc to the side of the waypoint, then a straight line along its tangent.
void Walk::legs_to(const WalkState& from, const WalkItem& item, std::vector<Leg>& legs) {
  const double dx = item.x_m - from.x_m;
  const double dy = item.y_m - from.y_m;
  const double ahead = std::cos(from.heading_rad) * dx + std::sin(from.heading_rad) * dy;
  const double left = -std::sin(from.heading_rad) * dx + std::cos(from.heading_rad) * dy;
  if (std::abs(left) < 1e-9 && ahead >= 0.0) {
    legs.push_back({.length_m = ahead, .speed_m_s = item.speed_m_s});
    return;
  }
  const double side = left >= 0.0 ? 1.0 : -1.0;
  const double lateral = std::abs(left);
  const double to_centre = std::hypot(ahead, lateral - item.radius_m);
  if (to_centre < item.radius_m)
    throw Error(
        fmt::format("waypoint ({}, {}) is inside the circle of its own turn (expected a smaller radius_m)",
                    item.x_m, item.y_m));
  // The angle of the arc up to the tangent point, on the circle around (0, radius).
  const double centre_bearing = std::atan2(lateral - item.radius_m, ahead);
  const double turn = centre_bearing + std::asin(std::min(1.0, item.radius_m / to_centre));
  const double turned = turn < -1e-9 ? turn + 2.0 * std::numbers::pi : std::max(turn, 0.0);
  legs.push_back({.length_m = turned * item.radius_m,
                  .curvature_1_m = side / item.radius_m,
                  .speed_m_s = item.speed_m_s});
  legs.push_back({.length_m = std::sqrt(std::max(0.0, to_centre * to_centre - item.radius_m * item.radius_m)),
                  .speed_m_s = item.speed_m_s});
}

std::vector<Walk::Leg> Walk::legs_of(WalkState state, const std::vector<WalkItem>& items) {
  std::vector<Leg> legs;
  for (const WalkItem& item : items) {
    const std::size_t first = legs.size();
    switch (item.step) {
      case WalkStep::Straight:
        legs.push_back({.length_m = item.length_m, .speed_m_s = item.speed_m_s});
        break;
      case WalkStep::Arc:
        legs.push_back({.length_m = std::abs(item.angle_rad) * item.radius_m,
                        .curvature_1_m = (item.angle_rad >= 0.0 ? 1.0 : -1.0) / item.radius_m,
                        .speed_m_s = item.speed_m_s});
        break;
      case WalkStep::To:
        legs_to(state, item, legs);
        break;
      case WalkStep::Pause:
        legs.push_back({.wait_s = item.duration_s});
        break;
      case WalkStep::Turn:
        legs.push_back({.wait_s = item.duration_s, .turn_rad = item.angle_rad});
        break;
      case WalkStep::Aside:
        legs.push_back({.length_m = std::abs(item.length_m),
                        .speed_m_s = item.speed_m_s,
                        .travel_rad = std::copysign(0.5 * std::numbers::pi, item.length_m)});
        break;
      case WalkStep::Back:
        legs.push_back(
            {.length_m = item.length_m, .speed_m_s = item.speed_m_s, .travel_rad = std::numbers::pi});
        break;
      case WalkStep::Sit:
        legs.push_back({.wait_s = item.duration_s, .sits = true});
        break;
    }
    for (std::size_t i = first; i < legs.size(); ++i) {
      state = after(state, legs[i].length_m, legs[i].curvature_1_m, legs[i].travel_rad);
      state.heading_rad += legs[i].turn_rad;
    }
  }
  return legs;
}

Walk::Walk(const WalkState& start, const std::vector<WalkItem>& items) {
  samples_.push_back(start);
  const std::vector<Leg> legs = legs_of(start, items);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    // The person stops between walking ahead, aside and back.
    const bool goes_on =
        i + 1 < legs.size() && legs[i + 1].moving() && legs[i + 1].travel_rad == legs[i].travel_rad;
    const double end_speed = goes_on ? std::min(legs[i].speed_m_s, legs[i + 1].speed_m_s) : 0.0;
    if (legs[i].moving())
      move(legs[i], end_speed);
    else if (legs[i].wait_s > 0.0)
      wait(legs[i]);
  }
}

void Walk::move(const Leg& leg, double end_speed_m_s) {
  const WalkState from = samples_.back();
  double gone_m = 0.0;
  double speed = from.speed_m_s;
  double stride = from.stride_rad;
  const double phase_sign = std::cos(leg.travel_rad) < -0.5 ? -1.0 : 1.0;
  while (leg.length_m - gone_m > 1e-9) {
    const double remaining = leg.length_m - gone_m;
    const double braking = std::sqrt(end_speed_m_s * end_speed_m_s + 2.0 * kAcceleration_m_s2 * remaining);
    speed = std::min({speed + kAcceleration_m_s2 * kStep_s, leg.speed_m_s, braking});
    gone_m = std::min(leg.length_m, gone_m + std::max(speed, 0.01) * kStep_s);
    stride += phase_sign * stride_rate_rad_s(speed) * kStep_s;
    WalkState state = after(from, gone_m, leg.curvature_1_m, leg.travel_rad);
    state.speed_m_s = speed;
    state.stride_rad = stride;
    state.travel_rad = leg.travel_rad;
    samples_.push_back(state);
  }
  samples_.back().speed_m_s = std::min(speed, std::max(end_speed_m_s, 0.0) + 0.02);
}

void Walk::wait(const Leg& leg) {
  WalkState state = samples_.back();
  state.speed_m_s = 0.0;
  const double from_rad = state.heading_rad;
  if (leg.sits)
    stools_.push_back({state.x_m - kSeatBehindFeet_m * std::cos(from_rad),
                       state.y_m - kSeatBehindFeet_m * std::sin(from_rad), from_rad});
  const int steps = static_cast<int>(std::lround(leg.wait_s / kStep_s));
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    state.heading_rad = from_rad + leg.turn_rad * smooth(share);
    if (leg.sits) {
      const double t_s = kStep_s * i;
      state.seat = smooth(std::clamp(std::min(t_s, leg.wait_s - t_s) / kSittingDown_s, 0.0, 1.0));
    }
    samples_.push_back(state);
  }
}

double Walk::duration_s() const {
  return kStep_s * static_cast<double>(samples_.size() - 1);
}

WalkState Walk::at(double t_s) const {
  if (t_s <= 0.0) return samples_.front();
  const double index = t_s / kStep_s;
  const auto low = static_cast<std::size_t>(index);
  if (low + 1 >= samples_.size()) {
    WalkState last = samples_.back();
    last.speed_m_s = 0.0;
    return last;
  }
  const WalkState& a = samples_[low];
  const WalkState& b = samples_[low + 1];
  const double f = index - static_cast<double>(low);
  WalkState state;
  state.x_m = a.x_m + f * (b.x_m - a.x_m);
  state.y_m = a.y_m + f * (b.y_m - a.y_m);
  state.heading_rad = a.heading_rad + f * (b.heading_rad - a.heading_rad);
  state.speed_m_s = a.speed_m_s + f * (b.speed_m_s - a.speed_m_s);
  state.stride_rad = a.stride_rad + f * (b.stride_rad - a.stride_rad);
  state.travel_rad = b.travel_rad;
  state.seat = a.seat + f * (b.seat - a.seat);
  return state;
}

}  // namespace heel::sim
