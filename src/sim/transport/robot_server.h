// Joins a P3At to a line, in whatever time the caller keeps.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "sim/robot/p3at.h"
#include "sim/transport/transport.h"

namespace heel::sim {

/// One line for a person, with the moment it is about.
using EventSink = std::function<void(TimeNs t_ns, const std::string& what)>;

/// Bytes as the client's line gave them, before the robot made anything of them.
using ByteSink = std::function<void(TimeNs t_ns, std::span<const std::uint8_t> bytes)>;

class RobotServer {
 public:
  RobotServer(P3At& robot, Transport& transport, EventSink on_event, ByteSink on_received = {})
      : robot_(robot),
        transport_(transport),
        on_event_(std::move(on_event)),
        on_received_(std::move(on_received)) {}

  /// Bytes in, robot on to `t_ns`, bytes out, events told. Call every millisecond or so.
  void step(TimeNs t_ns) {
    listen(t_ns);
    speak(t_ns);
  }
  /// The halves of a step. Where the process was held up before `t_ns`, what it finds on the line was sent
  /// meanwhile: the robot has it from the time of the last step on, not after a pause in which its watchdog
  /// would have run out.
  void listen(TimeNs t_ns);
  void speak(TimeNs t_ns);

 private:
  void watch_client(TimeNs t_ns);
  void read_client(TimeNs t_ns);

  P3At& robot_;
  Transport& transport_;
  EventSink on_event_;
  ByteSink on_received_;
  TimeNs t_last_ns_ = 0;  ///< the robot has been carried up to here
  bool client_present_ = false;
  int host_baud_ = 0;
  std::array<std::uint8_t, 1024> buffer_{};
};

}  // namespace heel::sim
