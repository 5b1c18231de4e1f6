// The pose of the robot in the odometry frame (odom), from the wrapping counters of the SIPs.
//
// odom outlives the connection: when the controller's counters restart (reset, reconnection), the pose
// continues from the last one, which is the new anchor. The counters since the anchor are summed as integers,
// so that no rounding errors accumulate.
#pragma once

#include <cstdint>

#include "arcos/sip.h"
#include "core/robot_model.h"
#include "heel/flow.h"

namespace heel {

class OdometryTracker {
 public:
  enum class Step : std::uint8_t {
    Moved,    ///< the pose follows the counters
    Rebased,  ///< the counters have restarted; the pose continues from the last one
    Suspect,  ///< farther than the robot can drive in that time: ignored unless the next SIP confirms it
  };

  explicit OdometryTracker(const RobotModel& model);

  /// Another robot, in whose units the next SIP is; the pose continues from the last one.
  void use(const RobotModel& model);

  /// Updates the pose from a SIP's position and speeds. `t_ns` is the stamp of its first byte.
  Step update(const arcos::Sip& sip, TimeNs t_ns);

  /// The connection was interrupted: the counters may have been set to zero before the next SIP.
  void interrupted() { interrupted_ = true; }
  /// The controller has reported a reset: the counters restart with the next SIP.
  void controller_reset() { rebase_next_ = true; }

  const Odometry& pose() const { return pose_; }

 private:
  struct Counters {
    int x = 0, y = 0, heading = 0;
    TimeNs t_ns = 0;
  };
  bool reachable(const Counters& from, const Counters& to) const;
  bool zeroed_meanwhile(const Counters& now) const;
  void anchor(const Counters& at);
  void advance(const Counters& to);

  double turn_rad(const Counters& from, const Counters& to) const;
  void set_units(const RobotModel& model);

  double metres_per_unit_ = 0.0;
  double speed_per_unit_m_s_ = 0.0;
  int heading_units_per_turn_ = 1;
  double rad_per_heading_unit_ = 0.0;
  double effective_track_m_ = 1.0;
  Odometry pose_;
  bool started_ = false;
  bool interrupted_ = false;
  bool rebase_next_ = false;
  bool has_suspect_ = false;
  Counters last_;
  Counters suspect_;

  // Counters since the anchor, and the anchor's pose in odom.
  std::int64_t units_x_ = 0, units_y_ = 0, units_heading_ = 0;
  double anchor_x_m_ = 0.0, anchor_y_m_ = 0.0, anchor_heading_rad_ = 0.0;
  double cos_odom_from_raw_ = 1.0, sin_odom_from_raw_ = 0.0;
};

}  // namespace heel
