#include "control/detour.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angles.h"

namespace heel {
namespace {

constexpr double kBeside_m = 0.15;   // from the robot's side to an echo beside it
constexpr double kAhead_m = 1.6;     // echoes farther along the trail do not count yet
constexpr double kPerson_m = 0.6;    // echoes so near to the person are the person's
constexpr double kStep_m = 0.05;     // between the offsets that are tried
constexpr double kAside_m_s = 0.15;  // how fast the offset changes
constexpr double kSearch_m = 0.1;    // between the places of the trail that an echo is compared with
constexpr TimeNs kSure_ns =
    300 * kNsPerMs;                       // each sonar is read three times a second: one echo is not enough
constexpr TimeNs kKept_ns = 2 * kNsPerS;  // the offset stays for this time after the way is free

/// An echo against the trail: along it, and beside it (left +).
struct Beside {
  double s_m, left_m;
};

Beside beside_trail(const Trail& trail, double from_m, double to_m, double x_m, double y_m) {
  Beside best{from_m, 0.0};
  double best_m = 1e9;
  for (int i = 0; from_m + i * kSearch_m <= to_m; ++i) {
    const double s = from_m + i * kSearch_m;
    const Trail::Place place = trail.at(s, 0.3);
    const double dx = x_m - place.x_m, dy = y_m - place.y_m;
    const double distance_m = std::hypot(dx, dy);
    if (distance_m >= best_m) continue;
    best_m = distance_m;
    const double left = std::cos(place.heading_rad) * dy - std::sin(place.heading_rad) * dx;
    best = {s, std::copysign(distance_m, left)};
  }
  return best;
}

}  // namespace

double Detour::offset_m(const Trail& trail, double robot_s_m, const Pose2& robot,
                        const SonarObstacles& obstacles, bool blocked, TimeNs now_ns) {
  const double dt_s = std::clamp(seconds_from_ns(now_ns - t_last_ns_), 0.0, 0.1);
  t_last_ns_ = now_ns;
  if (!blocked)
    t_block_ns_ = 0;
  else if (t_block_ns_ == 0)
    t_block_ns_ = now_ns;
  if (blocked && most_m_ > 0.0 && now_ns - t_block_ns_ >= kSure_ns) {
    std::array<double, kMaxSonars> left_m{};
    std::size_t count = 0;
    const double c = std::cos(robot.heading_rad), s = std::sin(robot.heading_rad);
    const double to_m = std::min(robot_s_m + kAhead_m, trail.tip_m() - kPerson_m);
    for (const ObstaclePoint& echo : obstacles.points()) {
      const Beside at = beside_trail(trail, robot_s_m, to_m, robot.x_m + c * echo.x_m - s * echo.y_m,
                                     robot.y_m + s * echo.x_m + c * echo.y_m);
      if (echo.x_m > 0.0 && at.s_m > robot_s_m && at.s_m < to_m - 0.5 * kSearch_m)
        left_m[count++] = at.left_m;
    }
    const double free_m = obstacles.half_width_m() + kBeside_m;
    const auto free = [&](double offset) {
      return std::all_of(left_m.begin(), left_m.begin() + count,
                         [&](double left) { return std::abs(left - offset) >= free_m; });
    };
    if (!free(wanted_m_)) {
      double best_m = 0.0, best_cost = 1e9;
      const int steps = static_cast<int>(2.0 * most_m_ / kStep_m + 1e-9);
      for (int i = 0; i <= steps; ++i) {
        const double offset = i * kStep_m - most_m_;
        const double cost = std::abs(offset) + 0.5 * std::abs(offset - wanted_m_);
        if (free(offset) && cost < best_cost) best_m = offset, best_cost = cost;
      }
      wanted_m_ = best_m;  // none is free: on the trail, where the gate lets the robot wait
    }
    t_blocked_ns_ = now_ns;
  } else if (!blocked && now_ns - t_blocked_ns_ > kKept_ns) {
    wanted_m_ = 0.0;
  }
  offset_m_ += std::clamp(wanted_m_ - offset_m_, -kAside_m_s * dt_s, kAside_m_s * dt_s);
  return offset_m_;
}

}  // namespace heel
