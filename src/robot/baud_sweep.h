// The baud rate to try next: the last good one, then every rate of an ARCOS controller.
#pragma once

#include <cstddef>

#include "robot/robot_address.h"

namespace heel {

class BaudSweep {
 public:
  /// A TCP line has one rate, which cannot be set.
  explicit BaudSweep(const RobotAddress& address)
      : sweeps_(address.kind != RobotAddress::Kind::Tcp),
        good_(sweeps_ ? address.baud : kRobotBauds.back()),
        current_(good_) {}

  int current() const { return current_; }
  /// The last rate at which the robot was understood.
  int good() const { return good_; }
  /// Changes to a rate that the robot was asked for; good() stays the same until found().
  void attempt(int baud) { current_ = baud; }
  /// True: the rate can be set.
  bool sweeps() const { return sweeps_; }
  /// The robot was understood at the current rate. The next sweep starts at the first rate, which a robot has
  /// after it was switched off and on.
  void found() {
    good_ = current_;
    next_ = 0;
  }
  void restart() {
    current_ = good_;
    next_ = 0;
  }
  /// Changes to the next rate. False: every rate has been tried, and the sweep starts again.
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
