// From a velocity command to VEL and RVEL: the last place where a command can still be refused.
//   expired, or not a number → zero;  first after a gap → zero;  rounding error carried forward
#pragma once

#include "arcos/command_codec.h"
#include "core/config.h"
#include "heel/flow.h"
#include "robot/command_pacer.h"
#include "robot/outgoing.h"
#include "robot/velocity_rounding.h"

namespace heel {

class MotionSender {
 public:
  explicit MotionSender(const RobotConfig& config);

  /// The next motion commands sent are zero, whatever is asked: a fresh connection, motors just enabled.
  void begin_with_zero();

  /// Adds VEL and RVEL to `out` as far as the pacer lets them; what did not fit goes first next time.
  void send(const VelocityCommand& command, TimeNs now_ns, CommandPacer& pacer, OutgoingBytes& out);
  /// The same with zero; the first commands after it are zero still.
  void send_zero(TimeNs now_ns, CommandPacer& pacer, OutgoingBytes& out);

 private:
  arcos::Frame next_frame(const VelocityCommand& command, bool zero);

  VelocityRounding translation_;  // mm/s
  VelocityRounding rotation_;     // deg/s
  bool rotation_next_ = false;    // VEL and RVEL take turns
  int zeros_to_send_ = 2;         // one of each
  TimeNs t_last_sent_ns_ = 0;
};

}  // namespace heel
