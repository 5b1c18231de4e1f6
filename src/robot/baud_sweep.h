// Which baud rate to try next: the last good one, then every rate an ARCOS controller knows.
#pragma once

#include <cstddef>

#include "robot/robot_address.h"

namespace heel {

class BaudSweep {
 public:
  /// Over TCP there is nothing to tune: one rate, until the robot tells that of its port.
  explicit BaudSweep(const RobotAddress& address)
      : sweeps_(address.kind != RobotAddress::Kind::Tcp),
        good_(sweeps_ ? address.baud : kRobotBauds.back()),
        current_(good_) {}

  int current() const { return current_; }
  /// The last rate at which the robot was understood.
  int good() const { return good_; }
  /// A rate the robot was asked for: the good one stays the good one until found() is said.
  void attempt(int baud) { current_ = baud; }
  /// The rate is ours to choose.
  bool sweeps() const { return sweeps_; }
  /// The robot was understood; the next sweep begins from the first rate, where a robot is that was off and
  /// on.
  void found() {
    good_ = current_;
    next_ = 0;
  }
  void restart() {
    current_ = good_;
    next_ = 0;
  }
  /// Moves on; false when every rate has been tried, and the sweep begins again.
  bool advance() {
    if (sweeps_) {
      while (next_ < kRobotBauds.size()) {
        current_ = kRobotBauds[next_++];
        if (current_ != good_) return true;
      }
    }
    restart();
    return false;
  }

 private:
  bool sweeps_;
  int good_;
  int current_;
  std::size_t next_ = 0;
};

}  // namespace heel
