// The room at its true depth: floor, walls with posters and shelves, ceiling, boxes and screens. All textures
// are procedural, from the seed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "sim/scene/light.h"
#include "sim/scene/mesh.h"
#include "sim/scene/obstacle.h"
#include "sim/scene/walk.h"
#include "sim/scene/world_use.h"

namespace heel::sim {

struct RoomSettings {
  double margin_m = 4.0;      ///< from the outermost point of all walks to the walls
  double clearance_m = 1.3;   ///< smallest distance of an object from the walks
  int objects = 40;           ///< number of boxes, shelves and screens
  int windows = 0;            ///< bright windows in the wall that the light comes from
  double window_light = 6.0;  ///< their brightness relative to a wall's
  double bump_m = 0.0;        ///< standard deviation of the ground's height; it pitches and rolls the robot
};

/// What determines the layout of the room: points of the walks, obstacles and stools.
struct FloorPlan {
  std::vector<Eigen::Vector2d> walked_m;
  std::vector<ObstacleSettings> obstacles;
  std::vector<StoolPlace> stools;
};

class Room {
 public:
  Room(const RoomSettings& settings, const FloorPlan& plan, const Light& light, double window_azimuth_rad,
       std::uint64_t seed, WorldUse use = WorldUse::Rendering);

  const std::vector<StaticFace>& faces() const { return faces_; }
  /// Of everything that stands on the floor, walls included.
  const std::vector<Footprint>& footprints() const { return footprints_; }

 private:
  /// Adds a rectangle from `origin` along `right` and `down` (metres), in patches of at most `patch_m`.
  void add_rectangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& right, const Eigen::Vector3d& down,
                     const Texture& texture, double texels_per_m, const Eigen::Vector2d& texture_origin,
                     double patch_m);
  /// Stores the texture that `draw` makes; with WorldUse::TruthOnly one texel in its place.
  const Texture& add_texture(const std::function<Canvas()>& draw);
  void add_block(const Block& block, const Texture& texture);
  void add_pole(const ObstacleSettings& pole, const Texture& texture);
  void add_windows(const RoomSettings& settings, const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                   double azimuth_rad);
  void add_obstacles(const FloorPlan& plan, std::uint64_t seed);
  void add_shell(const Eigen::Vector2d& low, const Eigen::Vector2d& high, std::uint64_t seed);
  void add_objects(const RoomSettings& settings, const FloorPlan& plan, const Eigen::Vector2d& low,
                   const Eigen::Vector2d& high, std::uint64_t seed);

  const Light& light_;
  WorldUse use_;
  std::deque<Texture> textures_;  ///< a deque, because faces hold pointers to them
  std::vector<StaticFace> faces_;
  std::vector<Footprint> footprints_;
};

}  // namespace heel::sim
