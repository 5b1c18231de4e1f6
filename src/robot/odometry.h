// The pose of the robot in odom, from the wrapping counters of the SIPs.
//
// The odom frame outlives the connection: when the controller's counters begin anew (reset, reconnection),
// the pose goes on from where it was. The counters since the last such anchor are kept as integers, so that
// nothing accumulates but what the robot itself reports.
#pragma once

#include <cstdint>

#include "arcos/sip.h"
#include "heel/flow.h"

namespace heel {

class OdometryTracker {
 public:
  enum class Step : std::uint8_t {
    Moved,    ///< taken
    Rebased,  ///< the counters began anew; the pose went on from the last one
    Suspect,  ///< farther than a robot can go in that time: left aside until the next SIP confirms or denies
              ///< it
  };

  /// `dist_conv_factor`: mm per unit of XPOS and YPOS.
  explicit OdometryTracker(double dist_conv_factor);

  /// Takes a SIP's position and speeds. `t_ns` is the stamp of its first byte.
  Step update(const arcos::Sip& sip, TimeNs t_ns);

  /// The connection was interrupted: at the next SIP the counters may have been zeroed meanwhile.
  void interrupted() { interrupted_ = true; }
  /// The controller said it has reset: at the next SIP the counters have begun anew.
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

  double metres_per_unit_;
  Odometry pose_;
  bool started_ = false;
  bool interrupted_ = false;
  bool rebase_next_ = false;
  bool has_suspect_ = false;
  Counters last_;
  Counters suspect_;

  // Counters since the anchor, and the anchor's place in odom.
  std::int64_t units_x_ = 0, units_y_ = 0, units_heading_ = 0;
  double anchor_x_m_ = 0.0, anchor_y_m_ = 0.0, anchor_heading_rad_ = 0.0;
  double cos_odom_from_raw_ = 1.0, sin_odom_from_raw_ = 0.0;
};

}  // namespace heel
