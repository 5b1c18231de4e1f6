// The surroundings at their true depth: floor, walls with posters and shelves, ceiling, boxes and screens.
// Everything is drawn by formula from the seed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "sim/scene/detail.h"
#include "sim/scene/light.h"
#include "sim/scene/mesh.h"
#include "sim/scene/obstacle.h"
#include "sim/scene/walk.h"

namespace heel::sim {

struct RoomSettings {
  double margin_m = 4.0;      ///< from the outermost walked point to the walls
  double clearance_m = 1.3;   ///< no object stands nearer to the walked path
  int objects = 40;           ///< boxes, shelves and screens
  int windows = 0;            ///< bright ones, in the wall the light comes from
  double window_light = 6.0;  ///< how much brighter than a lit wall they are
  double bump_m = 0.0;  ///< unevenness of the ground, one standard deviation: it pitches and rolls the robot
};

/// What the scenario puts into the room: the points to keep clear, and what stands where.
struct FloorPlan {
  std::vector<Eigen::Vector2d> walked_m;
  std::vector<ObstacleSettings> obstacles;
  std::vector<StoolPlace> stools;
};

class Room {
 public:
  Room(const RoomSettings& settings, const FloorPlan& plan, const Light& light, double window_azimuth_rad,
       std::uint64_t seed, Detail detail = Detail::Pictures);

  const std::vector<StaticFace>& faces() const { return faces_; }
  /// Everything that stands on the floor, walls included.
  const std::vector<Footprint>& footprints() const { return footprints_; }

 private:
  /// A rectangle from `origin` along `right` and `down` (metres), cut into patches of at most `patch_m`.
  void add_rectangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& right, const Eigen::Vector3d& down,
                     const Texture& texture, double texels_per_m, const Eigen::Vector2d& texture_origin,
                     double patch_m);
  /// A texture of the room's own; without pictures a single texel, drawn by nobody.
  const Texture& surface(const std::function<Canvas()>& drawn);
  void add_block(const Block& block, const Texture& texture);
  void add_pole(const ObstacleSettings& pole, const Texture& texture);
  void add_windows(const RoomSettings& settings, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                   double azimuth_rad);
  void add_placed(const FloorPlan& plan, std::uint64_t seed);
  void add_shell(const Eigen::Vector2d& low, const Eigen::Vector2d& high, std::uint64_t seed);
  void add_objects(const RoomSettings& settings, const FloorPlan& plan, const Eigen::Vector2d& low,
                   const Eigen::Vector2d& high, std::uint64_t seed);

  const Light& light_;
  Detail detail_;
  std::deque<Texture> textures_;  ///< faces keep pointers: addresses must stay
  std::vector<StaticFace> faces_;
  std::vector<Footprint> footprints_;
};

}  // namespace heel::sim
