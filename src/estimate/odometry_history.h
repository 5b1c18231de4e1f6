// The robot's recent poses in odom: where was the robot when a frame was taken?
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/pose2.h"
#include "heel/flow.h"

namespace heel {

/// The pose `dt_s` after `from` at constant speed and yaw rate (unicycle model).
Pose2 extrapolated(const Odometry& from, double dt_s);

/// A ring buffer of fixed size. Does not allocate.
class OdometryHistory {
 public:
  static constexpr std::size_t kCapacity = 64;  ///< 6.4 s at the robot's usual 10 packets a second
  /// Longest extrapolation after the newest packet.
  static constexpr TimeNs kMaxAhead_ns = 500 * kNsPerMs;

  /// Adds a packet that is newer than the last one; ignores others.
  void add(const Odometry& odometry);
  void clear() { size_ = 0; }

  /// The robot in odom at `t_ns`: interpolated between packets, extrapolated after the newest. No value when
  /// `t_ns` is before the oldest packet kept, or more than kMaxAhead_ns after the newest.
  std::optional<Pose2> pose_at(TimeNs t_ns) const;

 private:
  const Odometry& from_newest(std::size_t back) const {
    return ring_[(next_ + 2 * kCapacity - 1 - back) % kCapacity];
  }

  std::array<Odometry, kCapacity> ring_{};
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

}  // namespace heel
