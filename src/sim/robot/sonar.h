// The sonars: arrays of eight numbers each, of which some may not be fitted; each array fires one sonar per
// cycle, in the order of POLLING.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/pose2.h"
#include "core/robot_model.h"
#include "heel/time.h"

namespace heel::sim {

inline constexpr int kSonarsPerArray = 8;
inline constexpr int kSonarArraysMax = static_cast<int>(kMaxSonars) / kSonarsPerArray;

/// Gives the distance in metres from a sensor (its pose in the world) to the nearest obstacle ahead;
/// infinity: none.
using RangeFinder = std::function<double(const Pose2& sensor_in_world)>;

struct SonarReading {
  std::uint8_t number = 0;
  std::uint16_t range = 0;  ///< wire units
};

class SonarRing {
 public:
  explicit SonarRing(const RobotModel& model);

  void set_range_finder(RangeFinder range_m) { range_m_ = std::move(range_m); }
  void set_cycle(TimeNs cycle_ns) { cycle_ns_ = cycle_ns; }
  /// Arrays with at least one sonar; the numbers of array i begin at 8 i.
  int arrays() const { return arrays_; }
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

  RobotGeometry robot_;
  double mm_per_range_unit_;
  int arrays_ = 0;
  RangeFinder range_m_;
  TimeNs cycle_ns_ = 40 * kNsPerMs;
  TimeNs t_next_ns_ = 0;
  std::array<bool, kSonarArraysMax> enabled_{};
  std::array<std::vector<int>, kSonarArraysMax> order_;
  std::array<std::size_t, kSonarArraysMax> next_{};
  std::vector<SonarReading> readings_;
};

}  // namespace heel::sim
