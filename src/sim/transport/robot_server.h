// Connects a P3At to a transport: bytes from the client to the robot and back. The caller passes the time.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "sim/robot/p3at.h"
#include "sim/transport/transport.h"

namespace heel::sim {

/// Takes one event in words, with its time.
using EventSink = std::function<void(TimeNs t_ns, const std::string& what)>;

/// Takes the client's bytes as they came, before the robot reads them.
using ByteSink = std::function<void(TimeNs t_ns, std::span<const std::uint8_t> bytes)>;

class RobotServer {
 public:
  RobotServer(P3At& robot, Transport& transport, EventSink on_event, ByteSink on_received = {})
      : robot_(robot),
        transport_(transport),
        on_event_(std::move(on_event)),
        on_received_(std::move(on_received)) {}

  /// Bytes in, the robot to `t_ns`, bytes and events out. Call it about every millisecond.
  void step(TimeNs t_ns) {
    receive(t_ns);
    advance(t_ns);
  }
  // The halves of a step. When the process was delayed before `t_ns`, the bytes it finds were sent during the
  // delay: the robot receives them at the time of the last step, not after a pause in which its watchdog
  // would have run out.
  void receive(TimeNs t_ns);
  void advance(TimeNs t_ns);

 private:
  void check_client(TimeNs t_ns);
  void read_client(TimeNs t_ns);

  P3At& robot_;
  Transport& transport_;
  EventSink on_event_;
  ByteSink on_received_;
  TimeNs t_last_ns_ = 0;  ///< the robot has been advanced to here
  bool client_present_ = false;
  int host_baud_ = 0;
  std::array<std::uint8_t, 1024> buffer_{};
};

}  // namespace heel::sim
