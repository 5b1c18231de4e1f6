// How far beside the trail the robot passes an obstacle that the sonars detect on it.
#pragma once

#include "control/sonar_obstacles.h"
#include "control/trail.h"
#include "core/pose2.h"

namespace heel {

/// Keeps the side on which it passes until the way has been free for some time.
class Detour {
 public:
  void reconfigure(double most_m) { most_m_ = most_m; }
  void reset() {
    offset_m_ = wanted_m_ = 0.0;
    t_block_ns_ = t_blocked_ns_ = 0;
  }
  /// One tick: the offset from the trail to drive at, left +. `blocked`: an obstacle limits the robot's
  /// speed. Echoes near the person's place on the trail count as the person's.
  double offset_m(const Trail& trail, double robot_s_m, const Pose2& robot, const SonarObstacles& obstacles,
                  bool blocked, TimeNs now_ns);

 private:
  double most_m_ = 0.0;
  double wanted_m_ = 0.0;
  double offset_m_ = 0.0;
  TimeNs t_block_ns_ = 0;    // since when the way is blocked; 0: it is free
  TimeNs t_blocked_ns_ = 0;  // the last tick in which it was
  TimeNs t_last_ns_ = 0;
};

}  // namespace heel
