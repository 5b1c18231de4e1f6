// Turns velocity commands into VEL and RVEL. Zero is sent for an expired command, for NaN, and first after a
// gap; rounding errors are carried forward.
#pragma once

#include "arcos/command_codec.h"
#include "heel/flow.h"
#include "robot/command_pacer.h"
#include "robot/outgoing.h"
#include "robot/velocity_rounding.h"

namespace heel {

class MotionSender {
 public:
  /// Commands are clamped to ±v_limit_mm_s and ±yaw_rate_limit_deg_s.
  MotionSender(int v_limit_mm_s, int yaw_rate_limit_deg_s);

  /// The next VEL and RVEL are zero whatever the command is: for a new connection, and for motors just
  /// enabled.
  void begin_with_zero();

  /// Adds VEL and RVEL to `out` as far as the pacer allows; one that was left out is the first at the next
  /// call.
  void send(const VelocityCommand& command, TimeNs now_ns, CommandPacer& pacer, OutgoingBytes& out);
  /// The same with zero; the first VEL and RVEL after it are zero too.
  void send_zero(TimeNs now_ns, CommandPacer& pacer, OutgoingBytes& out);

 private:
  arcos::Frame next_frame(const VelocityCommand& command, bool zero);

  VelocityRounding translation_;  // mm/s
  VelocityRounding rotation_;     // deg/s
  bool rotation_next_ = false;    // VEL and RVEL alternate
  int zeros_to_send_ = 2;         // one of each
  TimeNs t_last_sent_ns_ = 0;
};

}  // namespace heel
