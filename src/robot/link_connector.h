// Opens, retunes and closes the line on a thread of its own, because a device may take long for it and the
// control thread has no time. The line itself is always owned by exactly one of the two; an atomic hands it
// over.
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
  /// The thread starts at once and waits; `pause_ns` is kept before every attempt to open but the first.
  LinkConnector(RobotAddress address, TimeNs pause_ns);
  ~LinkConnector();
  LinkConnector(const LinkConnector&) = delete;
  LinkConnector& operator=(const LinkConnector&) = delete;

  /// The line, when it is the caller's; else nullptr. Wait-free.
  SerialLine* line() { return owner_.load(std::memory_order_acquire) == Owner::Caller ? &line_ : nullptr; }

  /// Only from the line's owner, as retune(). Hands it over: it is closed and opened again, as often as it
  /// takes. The first call opens it.
  void open(int baud) { hand_over(Owner::KeeperOpens, baud); }
  /// Hands the line over for another baud rate; when that fails it is opened again.
  void retune(int baud) { hand_over(Owner::KeeperRetunes, baud); }

  /// Failed attempts so far, and why the last one failed ("" when none did). For a thread that may lock.
  std::uint64_t failures() const { return failures_.load(std::memory_order_relaxed); }
  std::string last_error() const;

 private:
  enum class Owner : int {  // an int waits on a futex directly
    Nobody,
    KeeperOpens,
    KeeperRetunes,
    Caller,
    Quit
  };
  void hand_over(Owner to, int baud);
  void run();
  bool open_until_it_works();
  void pause();

  const RobotAddress address_;
  const TimeNs pause_ns_;
  SerialLine line_;
  int baud_ = 0;
  bool tried_before_ = false;
  std::atomic<Owner> owner_{Owner::Nobody};
  std::atomic<bool> quit_{false};
  std::atomic<std::uint64_t> failures_{0};
  mutable std::mutex error_mutex_;  // never taken by the control thread
  std::string error_;
  std::thread thread_;
};

}  // namespace heel
