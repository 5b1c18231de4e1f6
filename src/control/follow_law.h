// A control law: from the estimated target to the wanted velocity, once a tick. The key control.law names the
// law in use, and control/follow_law_factory.h makes it.
#pragma once

#include "control/sonar_obstacles.h"
#include "core/config.h"
#include "heel/flow.h"

namespace heel {

/// What a law may use in one tick. The references are valid during the call.
struct FollowInput {
  TimeNs now_ns = 0;
  const TargetState& target;        ///< robot frame at `now_ns`
  const RobotState& robot;          ///< the newest packet, odometry included
  const SonarObstacles& obstacles;  ///< robot frame at `now_ns`
  /// The person is lost: the law may drive to where they were last seen and look for them. `target` is old.
  bool searching = false;
};

/// What a law wants. Supervisor and gate come after it: whatever it wants, they bring the robot to rest and
/// limit speed, acceleration and distances.
struct WantedVelocity {
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;  ///< counter-clockwise +
  /// Of a tick with `searching`: there is nothing left to search. The velocity is zero.
  bool search_done = false;
};

/// A law may keep a state between ticks, such as the person's path in odom. It reads no clock, and only its
/// constructor allocates.
class FollowLaw {
 public:
  virtual ~FollowLaw() = default;

  /// New gains and limits for the next tick; the state is kept.
  virtual void reconfigure(const Config& config) = 0;
  /// The robot may have moved unobserved (the line was interrupted): forgets everything that is kept in odom.
  virtual void reset() = 0;
  /// True: with `searching` the law can drive on without a target, along what it knows of the person's path.
  /// The supervisor limits the time (supervisor.search_s).
  virtual bool may_search() const { return false; }
  /// One tick.
  virtual WantedVelocity velocity(const FollowInput& input) = 0;
};

}  // namespace heel
