// The baud rate to try next. What a controller's port does after CLOSE is disputed: it keeps the rate that it
// was asked for, or falls back to the one that it has after power-on. Therefore a sweep begins with a quick
// look at the last good rate and at the power-on rate, and goes on with every rate of an ARCOS controller.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "robot/robot_address.h"

namespace heel {

class BaudSweep {
 public:
  /// A TCP line has one rate, which cannot be set.
  explicit BaudSweep(const RobotAddress& address)
      : sweeps_(address.kind != RobotAddress::Kind::Tcp),
        good_(sweeps_ ? address.baud : kRobotBauds.back()),
        current_(good_) {
    restart();
  }

  int current() const { return current_; }
  /// The last rate at which the robot was understood.
  int good() const { return good_; }
  /// Changes to a rate that the robot was asked for; good() stays the same until found().
  void attempt(int baud) { current_ = baud; }
  /// True: the rate can be set.
  bool sweeps() const { return sweeps_; }
  /// True: the current rate is to be tried for a short time; if the robot has it, it answers at once.
  bool quick() const { return next_ <= quick_; }
  /// The rate of the port after power-on, when the robot has said it (CONFIGpac).
  void set_power_on(int baud) { power_on_ = baud; }

  /// The robot was understood at the current rate: the next sweep starts with it.
  void found() {
    good_ = current_;
    plan(good_, power_on_);
  }
  void restart() {
    plan(good_, power_on_);
    current_ = order_[0];
  }
  /// The robot was sent CLOSE: its port may be at the power-on rate.
  void restart_after_close() {
    plan(power_on_, good_);
    current_ = order_[0];
  }
  /// Changes to the next rate. False: every rate has been tried, and the sweep starts again.
  bool advance() {
    if (next_ < size_) {
      current_ = order_[next_++];
      return true;
    }
    restart();
    return false;
  }

 private:
  void add(int baud) { order_[size_++] = baud; }
  void plan(int first, int second) {
    size_ = quick_ = 0;
    if (sweeps_ && first != second) {
      add(first);
      add(second);
      quick_ = size_;
    }
    const std::size_t full = size_;
    add(good_);
    for (std::size_t i = 0; sweeps_ && i <= kRobotBauds.size(); ++i) {
      const int baud = i == 0 ? power_on_ : kRobotBauds[i - 1];
      if (std::find(order_.begin() + full, order_.begin() + size_, baud) == order_.begin() + size_) add(baud);
    }
    next_ = 1;
  }

  bool sweeps_;
  int good_;
  int current_;
  int power_on_ = kRobotBauds.front();
  std::array<int, 2 + kRobotBauds.size() + 2> order_{};
  std::size_t size_ = 0;   ///< of `order_`
  std::size_t quick_ = 0;  ///< of them, at the front: quick ones
  std::size_t next_ = 0;   ///< place of the rate after the current one
};

}  // namespace heel
