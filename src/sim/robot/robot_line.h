// The robot's serial line, both directions, with simulated faults.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "sim/robot/fault.h"
#include "sim/robot/uart_line.h"

namespace heel::sim {

class RobotLine {
 public:
  RobotLine(int baud, std::uint64_t seed);

  int robot_baud() const { return robot_baud_; }
  void set_robot_baud(int baud);
  /// The rate of the client's end; 0: always the robot's (a line without a rate, such as TCP).
  void set_host_baud(int baud);
  void set_effects(const FaultEffects& effects) { effects_ = effects; }

  void from_host(std::span<const std::uint8_t> bytes, TimeNs t_ns);
  void from_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns);
  void arrive_at_robot(TimeNs t_ns, std::vector<std::uint8_t>& out) { to_robot_.receive_until(t_ns, out); }
  void arrive_at_host(TimeNs t_ns, std::vector<std::uint8_t>& out) { to_host_.receive_until(t_ns, out); }

  /// Number of the host's bytes that have not arrived yet.
  std::size_t input_backlog() const { return to_robot_.backlog(); }
  /// When the robot's port has sent everything, without the delay of a fault.
  TimeNs output_free_at_ns() const { return to_host_.free_at_ns() - effects_.delay_ns; }

 private:
  void apply_rates();
  /// `bytes` after losses and flipped bits.
  std::span<const std::uint8_t> damaged(std::span<const std::uint8_t> bytes);

  int robot_baud_;
  int host_baud_ = 0;
  UartLine to_robot_;
  UartLine to_host_;
  FaultEffects effects_;
  std::mt19937_64 random_;
  std::vector<std::uint8_t> damaged_;
};

}  // namespace heel::sim
