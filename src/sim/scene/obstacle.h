// Obstacles of a scenario: poles, boxes, walls and doorways. They are drawn, reflect sonar, press bumpers and
// hide the person.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace heel::sim {

enum class ObstacleKind : std::uint8_t { Pole, Box, Wall, Doorway };

struct ObstacleSettings {
  ObstacleKind kind = ObstacleKind::Box;
  double x_m = 0.0;  ///< its centre, world frame
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< direction of its length
  double length_m = 0.6;     ///< Box, Wall, Doorway: of the whole wall
  double width_m = 0.4;      ///< Box: across its length; Wall, Doorway: thickness
  double height_m = 1.0;
  double radius_m = 0.15;  ///< Pole
  double opening_m = 1.2;  ///< Doorway: clear width; the opening is in the middle
  double lintel_m = 2.1;   ///< Doorway: clear height
};

/// A block that stands on the floor or is above it.
struct Block {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  double length_m = 0.0;
  double width_m = 0.0;
  double bottom_m = 0.0;
  double top_m = 0.0;
};

/// The blocks of a box, a wall or a doorway (two sides and the lintel); none for a pole.
std::vector<Block> blocks_of(const ObstacleSettings& obstacle);

/// The shape of an obstacle on the floor, for sonars, bumpers and lines of sight: a rectangle or a disc.
struct Footprint {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  double length_m = 0.0;  ///< of the rectangle
  double width_m = 0.0;
  double radius_m = 0.0;  ///< > 0: a disc
  double top_m = 0.0;     ///< height

  /// Distance along a ray (unit direction) to the outline; infinity when the ray misses it; 0 from inside.
  double ray_m(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction) const;
  /// The point of the shape nearest to `point_m`; `point_m` itself when it is inside.
  Eigen::Vector2d nearest_m(const Eigen::Vector2d& point_m) const;
  /// Distance to the nearest part within a cone around `axis_rad`; infinity when there is none; 0 from
  /// inside.
  double in_cone_m(const Eigen::Vector2d& from_m, double axis_rad, double half_angle_rad) const;
  /// The largest distance of any part from the centre.
  double reach_m() const;
};

}  // namespace heel::sim
