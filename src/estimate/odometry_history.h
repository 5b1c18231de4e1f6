// The robot's recent path in odom, so that a frame can be placed where the robot was when it was taken.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/pose2.h"
#include "heel/flow.h"

namespace heel {

/// Where a robot is `dt_s` later that keeps its speed and yaw rate: the unicycle's arc, by its chord.
Pose2 extrapolated(const Odometry& from, double dt_s);

/// A fixed ring of odometry, newest last. Does not allocate.
class OdometryHistory {
 public:
  static constexpr std::size_t kCapacity = 64;  ///< 6.4 s at the robot's usual 10 packets a second
  /// Beyond the newest packet the robot is taken to keep its speed and yaw rate for at most this long.
  static constexpr TimeNs kMaxAhead_ns = 500 * kNsPerMs;

  /// Keeps the packet unless it is not newer than the last one.
  void push(const Odometry& odometry);
  void clear() { size_ = 0; }

  /// The robot in odom at `t_ns`: interpolated between packets, carried on along an arc after the newest.
  /// Nothing when t_ns is older than the ring or too far ahead of it.
  std::optional<Pose2> at(TimeNs t_ns) const;

 private:
  const Odometry& from_newest(std::size_t back) const {
    return ring_[(next_ + 2 * kCapacity - 1 - back) % kCapacity];
  }

  std::array<Odometry, kCapacity> ring_{};
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace heel
