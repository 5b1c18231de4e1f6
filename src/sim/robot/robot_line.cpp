#include "sim/robot/robot_line.h"

namespace heel::sim {

RobotLine::RobotLine(int baud, std::uint64_t seed)
    : robot_baud_(baud), to_robot_(baud), to_host_(baud), random_(seed) {}

void RobotLine::set_robot_baud(int baud) {
  robot_baud_ = baud;
  apply_rates();
}

void RobotLine::set_host_baud(int baud) {
  host_baud_ = baud;
  apply_rates();
}

void RobotLine::apply_rates() {
  const int host_baud = host_baud_ > 0 ? host_baud_ : robot_baud_;
  to_robot_.set_sender_baud(host_baud);
  to_robot_.set_receiver_baud(robot_baud_);
  to_host_.set_sender_baud(robot_baud_);
  to_host_.set_receiver_baud(host_baud);
}

void RobotLine::from_host(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  to_robot_.send(damaged(bytes), t_ns + effects_.delay_ns);
}

void RobotLine::from_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) {
  if (effects_.silence) return;
  to_host_.send(damaged(bytes), t_ns + effects_.delay_ns);
}

std::span<const std::uint8_t> RobotLine::damaged(std::span<const std::uint8_t> bytes) {
  if (effects_.drop_share <= 0.0 && effects_.garble_share <= 0.0) return bytes;
  std::uniform_real_distribution<double> share(0.0, 1.0);
  damaged_.clear();
  for (std::uint8_t byte : bytes) {
    if (share(random_) < effects_.drop_share) continue;
    if (share(random_) < effects_.garble_share)
      byte = static_cast<std::uint8_t>(byte ^ (1u << (random_() % 8)));
    damaged_.push_back(byte);
  }
  return damaged_;
}

}  // namespace heel::sim
