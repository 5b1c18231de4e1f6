// The robot's line and the session on it, for the control thread. After construction nothing here allocates,
// locks or waits, except shutdown(), which takes a bounded time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/config.h"
#include "heel/flow.h"
#include "realtime/spsc_queue.h"
#include "robot/arcos_session.h"
#include "robot/link_connector.h"

namespace heel {

class RobotLink {
 public:
  /// Throws heel::Error when the address cannot be understood. Begins to open the line at once, on a helper
  /// thread: opening a device or looking up a host may take seconds. `wire`, where given, gets every byte
  /// that is read or written; it is borrowed.
  explicit RobotLink(const RobotConfig& config, SpscQueue<WireBytes>* wire = nullptr);
  /// Shuts down, if that has not been done.
  ~RobotLink();

  /// The beginning of a control tick, its only read: takes in what the robot has sent. The result is what
  /// control and session decide on in this tick.
  const RobotState& read(TimeNs now_ns);

  /// Between read() and write() of a tick: ArcosSession::enable_motors_again().
  void enable_motors_again(TimeNs now_ns) { session_.enable_motors_again(now_ns); }

  /// The end of the same tick, at the same `now_ns`: writes what the session makes of the command.
  void write(const VelocityCommand& command, TimeNs now_ns);

  /// Reads until `deadline_ns` of CLOCK_MONOTONIC, in place of sleeping to the next tick, and stamps the
  /// bytes as they arrive. A SIP that is stamped only at the tick would appear up to a period newer than it
  /// is.
  void receive_until(TimeNs deadline_ns);

  /// Sends STOP, SONAR 0 and CLOSE and waits until they are on the wire, 0.3 s at most. The link ends with
  /// it.
  void shutdown(TimeNs now_ns);

  const RobotState& state() const { return session_.state(); }
  /// For the event OtherDevice.
  std::string_view heard_text() const { return session_.heard_text(); }
  bool next_event(SessionEvent& event) { return session_.next_event(event); }

  /// Failed attempts to open the line, and the last reason; for threads that may lock and allocate.
  std::uint64_t open_failures() const { return connector_.failures(); }
  std::string last_open_error() const { return connector_.last_error(); }
  std::uint64_t open_notes() const { return connector_.notes(); }
  std::string last_open_note() const { return connector_.last_note(); }

 private:
  SerialLine* usable_line(TimeNs now_ns);
  void read_all(SerialLine& line, TimeNs now_ns);
  void write_pending(TimeNs now_ns);
  void lose_line(TimeNs now_ns);
  void report(std::span<const std::uint8_t> bytes, bool to_robot, TimeNs t_ns);

  ArcosSession session_;
  LinkConnector connector_;
  SpscQueue<WireBytes>* const wire_;
  bool line_up_ = false;  ///< session_.line_opened() has been called
  bool finished_ = false;
  int line_baud_;

  bool may_write_ = false;  ///< in this tick: the line is up and the driver has taken what was written before

  // What the driver did not take of the last tick's bytes.
  std::array<std::uint8_t, 512> pending_{};
  std::size_t pending_begin_ = 0;
  std::size_t pending_end_ = 0;
  TimeNs t_progress_ns_ = 0;  ///< when the driver last took everything
};

}  // namespace heel
