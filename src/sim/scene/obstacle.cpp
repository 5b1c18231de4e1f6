#include "sim/scene/obstacle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/angles.h"

namespace heel::sim {
namespace {

constexpr double kNoHit_m = std::numeric_limits<double>::infinity();

Eigen::Vector2d rotated(const Eigen::Vector2d& v, double angle_rad) {
  const double c = std::cos(angle_rad);
  const double s = std::sin(angle_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

double disc_ray_m(const Eigen::Vector2d& from, const Eigen::Vector2d& direction, double radius_m) {
  const double ahead = -from.dot(direction);
  const double off2 = from.squaredNorm() - ahead * ahead;
  const double half2 = radius_m * radius_m - off2;
  if (half2 < 0.0) return kNoHit_m;
  const double exit = ahead + std::sqrt(half2);
  return exit < 0.0 ? kNoHit_m : std::max(0.0, ahead - std::sqrt(half2));
}

}  // namespace

std::vector<Block> blocks_of(const ObstacleSettings& o) {
  const Eigen::Vector2d centre(o.x_m, o.y_m);
  const Block whole{centre, o.heading_rad, o.length_m, o.width_m, 0.0, o.height_m};
  if (o.kind == ObstacleKind::Pole) return {};
  if (o.kind != ObstacleKind::Doorway) return {whole};
  const double jamb_m = 0.5 * (o.length_m - o.opening_m);
  const Eigen::Vector2d along(std::cos(o.heading_rad), std::sin(o.heading_rad));
  const double middle_m = 0.5 * (o.opening_m + jamb_m);
  Block left = whole;
  left.length_m = jamb_m;
  left.centre_m = centre - middle_m * along;
  Block right = left;
  right.centre_m = centre + middle_m * along;
  Block over = whole;
  over.length_m = o.opening_m;
  over.bottom_m = o.lintel_m;
  return {left, right, over};
}

double Footprint::reach_m() const {
  return radius_m > 0.0 ? radius_m : 0.5 * std::hypot(length_m, width_m);
}

double Footprint::ray_m(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction) const {
  if (radius_m > 0.0) return disc_ray_m(from_m - centre_m, direction, radius_m);
  const Eigen::Vector2d from = rotated(from_m - centre_m, -heading_rad);
  const Eigen::Vector2d along = rotated(direction, -heading_rad);
  const Eigen::Vector2d half(0.5 * length_m, 0.5 * width_m);
  double enter = 0.0;
  double leave = kNoHit_m;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(along[axis]) < 1e-12) {
      if (std::abs(from[axis]) > half[axis]) return kNoHit_m;
      continue;
    }
    const double a = (-half[axis] - from[axis]) / along[axis];
    const double b = (half[axis] - from[axis]) / along[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : kNoHit_m;
}

Eigen::Vector2d Footprint::nearest_m(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d off = point_m - centre_m;
  if (radius_m > 0.0) {
    const double distance = off.norm();
    return distance <= radius_m ? point_m : Eigen::Vector2d(centre_m + off * (radius_m / distance));
  }
  const Eigen::Vector2d half(0.5 * length_m, 0.5 * width_m);
  const Eigen::Vector2d inside = rotated(off, -heading_rad).cwiseMax(-half).cwiseMin(half);
  return centre_m + rotated(inside, heading_rad);
}

double Footprint::in_cone_m(const Eigen::Vector2d& from_m, double axis_rad, double half_angle_rad) const {
  // The shape is convex: its nearest part in the cone is its nearest part of all, or on an edge of the cone.
  const Eigen::Vector2d to_nearest_m = nearest_m(from_m) - from_m;
  const double off_rad = wrap_angle_rad(std::atan2(to_nearest_m.y(), to_nearest_m.x()) - axis_rad);
  if (std::abs(off_rad) <= half_angle_rad) return to_nearest_m.norm();
  const auto along_edge = [&](double edge_rad) {
    return ray_m(from_m, {std::cos(edge_rad), std::sin(edge_rad)});
  };
  return std::min(along_edge(axis_rad - half_angle_rad), along_edge(axis_rad + half_angle_rad));
}

}  // namespace heel::sim
