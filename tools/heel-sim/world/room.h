// The surroundings at their true depth: floor, walls with posters and shelves, ceiling, boxes and screens.
// Everything is drawn by formula from the seed.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <vector>

#include "heel-sim/world/light.h"
#include "heel-sim/world/mesh.h"

namespace heel::sim {

struct RoomSettings {
  double margin_m = 4.0;     ///< from the outermost walked point to the walls
  double clearance_m = 1.3;  ///< no object stands nearer to the walked path
  int objects = 40;          ///< boxes, shelves and screens
};

/// A rectangle of floor to keep in the room, and the points to keep clear.
struct FloorPlan {
  std::vector<Eigen::Vector2d> walked_m;
};

class Room {
 public:
  Room(const RoomSettings& settings, const FloorPlan& plan, const Light& light, std::uint64_t seed);

  const std::vector<StaticFace>& faces() const { return faces_; }

 private:
  /// A rectangle from `origin` along `right` and `down` (metres), cut into patches of at most `patch_m`.
  void add_rectangle(const Eigen::Vector3d& origin, const Eigen::Vector3d& right, const Eigen::Vector3d& down,
                     const Texture& texture, double texels_per_m, const Eigen::Vector2d& texture_origin,
                     double patch_m);
  void add_box(const Eigen::Vector2d& centre, const Eigen::Vector3d& size, double heading_rad,
               const Texture& texture);
  void add_shell(const Eigen::Vector2d& low, const Eigen::Vector2d& high, std::uint64_t seed);
  void add_objects(const RoomSettings& settings, const FloorPlan& plan, const Eigen::Vector2d& low,
                   const Eigen::Vector2d& high, std::uint64_t seed);

  const Light& light_;
  std::deque<Texture> textures_;  ///< faces keep pointers: addresses must stay
  std::vector<StaticFace> faces_;
};

}  // namespace heel::sim
