#include "robot/motion_sender.h"

#include "robot/wire_units.h"

namespace heel {
namespace {

// A longer time without a motion command is a gap: the robot may have stopped, or may resume an old motion.
constexpr TimeNs kGap_ns = 250 * kNsPerMs;

}  // namespace

MotionSender::MotionSender(int v_limit_mm_s, int yaw_rate_limit_deg_s)
    : translation_(v_limit_mm_s), rotation_(yaw_rate_limit_deg_s) {}

void MotionSender::begin_with_zero() {
  zeros_to_send_ = 2;
}

arcos::Frame MotionSender::next_frame(const VelocityCommand& command, bool zero) {
  if (rotation_next_) {
    const double asked = zero ? 0.0 : wire::deg_s_from_rad_s(command.yaw_rate_rad_s);
    return arcos::encode_integer(arcos::CommandId::RVel, rotation_.next(asked));
  }
  const double asked = zero ? 0.0 : wire::mm_s_from_m_s(command.v_m_s);
  return arcos::encode_integer(arcos::CommandId::Vel, translation_.next(asked));
}

void MotionSender::send(const VelocityCommand& command, TimeNs now_ns, CommandPacer& pacer,
                        OutgoingBytes& out) {
  if (now_ns - t_last_sent_ns_ > kGap_ns) begin_with_zero();
  const bool expired = now_ns > command.t_expires_ns;
  for (int i = 0; i < 2 && pacer.may_repeat(now_ns); ++i) {
    const arcos::Frame frame = next_frame(command, expired || zeros_to_send_ > 0);
    if (zeros_to_send_ > 0) --zeros_to_send_;
    rotation_next_ = !rotation_next_;
    out.append(frame);
    pacer.repeated(frame.size(), now_ns);
    t_last_sent_ns_ = now_ns;
  }
}

void MotionSender::send_zero(TimeNs now_ns, CommandPacer& pacer, OutgoingBytes& out) {
  send(VelocityCommand{}, now_ns, pacer, out);
  begin_with_zero();
}

}  // namespace heel
