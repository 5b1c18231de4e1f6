// The robot's contact with the world: sonar ranges, pressed bumpers, and the floor it turns on.
#pragma once

#include <vector>

#include "sim/robot/p3at.h"
#include "sim/scene/world.h"

namespace heel::sim {

class Contact {
 public:
  /// `world` and `robot` must outlive it.
  Contact(const World& world, P3At& robot);

  /// Call it after every advance of the robot, at least every few milliseconds. Bumper segments are numbered
  /// 0…4 from left to right in front and from right to left behind. The robot does not drive through
  /// anything: it stays where it was while its wheels turn.
  void step(double t_s);

 private:
  std::vector<Footprint> nearby_footprints() const;
  void choose_floor();

  const World& world_;
  P3At& robot_;
  double t_s_ = 0.0;
  Pose2 free_pose_;  ///< the robot's last pose without a collision
};

}  // namespace heel::sim
