// One direction of an asynchronous serial line, 8N1, down to its bits: bytes take their time, and a receiver
// set to another rate than the sender samples the wave where its own clock says, and so reads the garbage a
// real UART would read.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "heel/time.h"

namespace heel::sim {

class UartLine {
 public:
  explicit UartLine(int baud) : sender_baud_(baud), receiver_baud_(baud) {}

  void set_sender_baud(int baud) { sender_baud_ = baud; }      ///< for bytes sent from now on
  void set_receiver_baud(int baud) { receiver_baud_ = baud; }  ///< for bytes whose start bit is yet to come

  /// Queues bytes behind those on the line; the first leaves at `t_ns` at the earliest.
  void send(std::span<const std::uint8_t> bytes, TimeNs t_ns);
  /// Appends what the receiver has by `t_ns`. Whatever is sent later must not start before `t_ns`.
  void receive_until(TimeNs t_ns, std::vector<std::uint8_t>& out);
  /// Forgets everything on the line.
  void clear();

  TimeNs free_at_ns() const { return t_free_ns_; }        ///< when the last queued byte has left
  std::size_t backlog() const { return frames_.size(); }  ///< bytes not yet wholly received

 private:
  struct Frame {
    TimeNs t_start_ns;
    TimeNs t_end_ns;  ///< of the stop bit
    int baud;
    std::uint8_t byte;
  };
  struct Edge {
    bool found;
    TimeNs t_ns;
  };
  Edge next_falling_edge() const;
  bool level_at(TimeNs t_ns) const;

  int sender_baud_;
  int receiver_baud_;
  std::deque<Frame> frames_;  ///< by start; idle (high) between them
  TimeNs t_free_ns_ = 0;
  TimeNs t_search_ns_ = 0;  ///< the receiver looks for a start bit from here on
};

}  // namespace heel::sim
