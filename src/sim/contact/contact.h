// The robot among the things of the world: what its sonars hear, what its bumpers meet, and the floor it
// turns on.
#pragma once

#include <vector>

#include "sim/robot/p3at.h"
#include "sim/scene/world.h"

namespace heel::sim {

class Contact {
 public:
  /// Both must outlive it.
  Contact(const World& world, P3At& robot);

  /// Call after every advance of the robot, a few milliseconds apart at most. Bumper segments are numbered
  /// 0…4 from left to right in front and from right to left behind. What is solid is not driven through: the
  /// robot stays where it was, whatever its wheels do.
  void step(double t_s);

 private:
  std::vector<Footprint> near() const;
  void choose_floor();

  const World& world_;
  P3At& robot_;
  double t_s_ = 0.0;
  Pose2 free_pose_;  ///< the last that was not inside anything
};

}  // namespace heel::sim
