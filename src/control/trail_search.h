// At the end of the trail of a person who is lost: looks where they were heading, then to the other side.
#pragma once

#include "heel/flow.h"

namespace heel {

/// The headings are in odom.
class TrailSearch {
 public:
  void reconfigure(double look_rad, double turn_rad_s) {
    look_rad_ = look_rad;
    turn_rad_s_ = turn_rad_s;
  }
  /// A new search: the person was last seen with the direction of travel `heading_rad`, on the side `side`
  /// (+1: left).
  void begin(double heading_rad, double side);
  void end() { step_ = Step::None; }
  bool running() const { return step_ != Step::None; }
  bool done() const { return step_ == Step::Done; }
  /// One tick at the end of the trail: the yaw rate.
  double yaw_rate_rad_s(double robot_heading_rad, TimeNs now_ns);

 private:
  enum class Step : unsigned char { None, First, Other, Done };
  double heading_rad_ = 0.0;
  double side_ = 1.0;
  double look_rad_ = 0.0;
  double turn_rad_s_ = 0.0;
  Step step_ = Step::None;
  TimeNs t_there_ns_ = 0;  ///< since when the robot has looked there; 0: it is turning
};

}  // namespace heel
