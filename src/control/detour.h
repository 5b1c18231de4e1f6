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
  void reset() { offset_m_ = wanted_m_ = 0.0; }
  /// One tick: the offset from the trail to drive at, left +. `blocked`: an obstacle limits the robot's
  /// speed. Echoes within `person_m` along the trail of the person count as the person.
  double offset_m(const Trail& trail, double robot_s_m, const Pose2& robot, const SonarObstacles& obstacles,
                  bool blocked, TimeNs now_ns);
  bool active() const { return offset_m_ != 0.0 || wanted_m_ != 0.0; }

 private:
  double most_m_ = 0.0;
  double wanted_m_ = 0.0;
  double offset_m_ = 0.0;
  TimeNs t_free_ns_ = 0;  // the last tick in which the way was free
  TimeNs t_blocked_ns_ = 0;
  TimeNs t_last_ns_ = 0;
};

}  // namespace heel
