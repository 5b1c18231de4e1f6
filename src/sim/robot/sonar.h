// The sixteen sonars: two arrays of eight; each array fires one sonar per cycle, in the order of POLLING.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/pose2.h"
#include "heel/time.h"

namespace heel::sim {

inline constexpr int kSonarCount = 16;
inline constexpr int kSonarsPerArray = 8;
inline constexpr int kSonarArrays = 2;

/// The place of sonar `number` (0…15) on the robot: 0…7 in front from left to right, 8…15 behind from right
/// to left.
Pose2 sonar_mount(int number);

/// Gives the distance in metres from a sensor (its pose in the world) to the nearest obstacle ahead;
/// infinity: none.
using RangeFinder = std::function<double(const Pose2& sensor_in_world)>;

struct SonarReading {
  std::uint8_t number = 0;
  std::uint16_t range_mm = 0;
};

class SonarRing {
 public:
  SonarRing();

  void set_range_finder(RangeFinder range_m) { range_m_ = std::move(range_m); }
  void set_cycle(TimeNs cycle_ns) { cycle_ns_ = cycle_ns; }
  /// `array` 0 front, 1 rear.
  void enable(int array, bool on) { enabled_[static_cast<std::size_t>(array)] = on; }
  void enable_all(bool on) { enabled_.fill(on); }
  bool enabled(int array) const { return enabled_[static_cast<std::size_t>(array)]; }
  /// Numbers from 1, as in POLLING; an array without any number stops firing. Empty: the default order.
  void set_polling(std::span<const std::uint8_t> numbers);

  /// Fires the sonars that are due at `t_ns`.
  void advance(TimeNs t_ns, const Pose2& robot_in_world);
  /// The readings since the last call, oldest first.
  std::vector<SonarReading> take_readings();

 private:
  void fire(int number, const Pose2& robot_in_world);

  RangeFinder range_m_;
  TimeNs cycle_ns_ = 40 * kNsPerMs;
  TimeNs t_next_ns_ = 0;
  std::array<bool, kSonarArrays> enabled_{};
  std::array<std::vector<int>, kSonarArrays> order_;
  std::array<std::size_t, kSonarArrays> next_{};
  std::vector<SonarReading> readings_;
};

}  // namespace heel::sim
