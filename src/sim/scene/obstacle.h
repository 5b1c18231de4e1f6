// What stands in the way: poles, boxes, walls and doorways that a scenario places. Drawn, heard by sonars,
// met by bumpers; and they hide the person.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace heel::sim {

enum class ObstacleKind : std::uint8_t { Pole, Box, Wall, Doorway };

struct ObstacleSettings {
  ObstacleKind kind = ObstacleKind::Box;
  double x_m = 0.0;  ///< its middle; world frame
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< of its length; walls and doorways run along it
  double length_m = 0.6;     ///< Box, Wall, Doorway: of the whole wall
  double width_m = 0.4;      ///< Box: across its length; Wall, Doorway: thickness
  double height_m = 1.0;
  double radius_m = 0.15;  ///< Pole
  double opening_m = 1.2;  ///< Doorway: clear width, in the middle
  double lintel_m = 2.1;   ///< Doorway: clear height
};

/// A block of the room standing on the floor, or hanging over it.
struct Block {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  double length_m = 0.0;
  double width_m = 0.0;
  double bottom_m = 0.0;
  double top_m = 0.0;
};

/// The blocks of a box, wall or doorway (two jambs and what is over the opening).
std::vector<Block> blocks_of(const ObstacleSettings& obstacle);

/// A shape on the floor as sonars, bumpers and lines of sight meet it: a rectangle or a disc.
struct Footprint {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  double length_m = 0.0;  ///< of a rectangle
  double width_m = 0.0;
  double radius_m = 0.0;  ///< > 0: a disc
  double top_m = 0.0;     ///< from the floor up to here

  /// Distance along a ray (unit direction) to its outline; infinity when it is missed. 0 from inside.
  double ray_m(const Eigen::Vector2d& from_m, const Eigen::Vector2d& direction) const;
  /// Nearest point of it, outline or inside, to `point_m`.
  Eigen::Vector2d nearest_m(const Eigen::Vector2d& point_m) const;
  /// Distance to its nearest part within a cone about `axis_rad`; infinity when there is none. 0 from inside.
  double in_cone_m(const Eigen::Vector2d& from_m, double axis_rad, double half_angle_rad) const;
  /// No part of it is farther from its centre.
  double reach_m() const;
};

}  // namespace heel::sim
