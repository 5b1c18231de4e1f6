// One direction of an asynchronous serial line, 8N1, bit by bit. Bytes take the time of their bits, and a
// receiver at another rate than the sender's samples the signal by its own clock, so that it reads the
// garbage a real UART reads.
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

  void set_sender_baud(int baud) { sender_baud_ = baud; }  ///< for bytes sent from now on
  void set_receiver_baud(int baud) {
    receiver_baud_ = baud;
  }  ///< for bytes whose start bit is not received yet

  /// Sends bytes after those on the line, the first not before `t_ns`.
  void send(std::span<const std::uint8_t> bytes, TimeNs t_ns);
  /// Appends the bytes that are received by `t_ns`. Bytes sent later must not start before `t_ns`.
  void receive_until(TimeNs t_ns, std::vector<std::uint8_t>& out);
  /// Removes everything from the line.
  void clear();

  TimeNs free_at_ns() const { return t_free_ns_; }        ///< when the last byte has been sent
  std::size_t backlog() const { return frames_.size(); }  ///< bytes not yet received completely

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
  std::deque<Frame> frames_;  ///< in order of start; the line is idle (high) between them
  TimeNs t_free_ns_ = 0;
  TimeNs t_search_ns_ = 0;  ///< from here on the receiver waits for a start bit
};

}  // namespace heel::sim
