// Opens and closes the line and sets its rate on a thread of its own, because a device may take long for this
// and the control thread must not wait. Either the connector's thread or the caller owns the line; an atomic
// hands it over.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "heel/time.h"
#include "robot/robot_address.h"
#include "robot/serial_line.h"

namespace heel {

class LinkConnector {
 public:
  /// Starts the thread, which waits for open(). There is a pause of `pause_ns` before every attempt to open
  /// but the first.
  LinkConnector(RobotAddress address, TimeNs pause_ns);
  ~LinkConnector();
  LinkConnector(const LinkConnector&) = delete;
  LinkConnector& operator=(const LinkConnector&) = delete;

  /// The line when the caller owns it, else nullptr. Wait-free.
  SerialLine* line() { return owner_.load(std::memory_order_acquire) == Owner::Caller ? &line_ : nullptr; }

  /// Hands the line over: it is closed and opened until that succeeds. Only the owner may call this and
  /// retune(); the first call opens the line.
  void open(int baud) { hand_over(Owner::ConnectorOpens, baud); }
  /// Hands the line over to set another baud rate; if that fails, the line is opened again.
  void retune(int baud) { hand_over(Owner::ConnectorRetunes, baud); }

  /// Failed attempts so far, and the error of the last one (empty: none). For threads that may lock.
  std::uint64_t failures() const { return failures_.load(std::memory_order_relaxed); }
  std::string last_error() const;
  /// Openings after which a person should know something, and what.
  std::uint64_t notes() const { return notes_.load(std::memory_order_relaxed); }
  std::string last_note() const;

 private:
  enum class Owner : int {  // an int waits on a futex directly
    None,
    ConnectorOpens,
    ConnectorRetunes,
    Caller,
    Quit
  };
  void hand_over(Owner to, int baud);
  void run();
  bool open_until_success();
  void pause();

  const RobotAddress address_;
  const TimeNs pause_ns_;
  SerialLine line_;
  int baud_ = 0;
  bool tried_before_ = false;
  std::atomic<Owner> owner_{Owner::None};
  std::atomic<bool> quit_{false};
  std::atomic<std::uint64_t> failures_{0};
  std::atomic<std::uint64_t> notes_{0};
  mutable std::mutex error_mutex_;  // never taken by the control thread
  std::string error_;
  std::string note_;
  std::thread thread_;
};

}  // namespace heel
