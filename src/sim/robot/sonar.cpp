#include "sim/robot/sonar.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace heel::sim {
namespace {

constexpr double kFarthest_m = 5.0;  // also reported without an echo
constexpr double kNearest_m = 0.15;

}  // namespace

SonarRing::SonarRing(const RobotModel& model)
    : robot_(model.geometry), mm_per_range_unit_(model.mm_per_range_unit) {
  for (int number = 0; number < static_cast<int>(kMaxSonars); ++number) {
    if (robot_.has_sonar(static_cast<std::size_t>(number))) arrays_ = number / kSonarsPerArray + 1;
  }
  set_polling({});
}

void SonarRing::set_polling(std::span<const std::uint8_t> numbers) {
  for (std::vector<int>& order : order_) order.clear();
  const auto add = [this](int number) {
    if (!robot_.has_sonar(static_cast<std::size_t>(number))) return;
    order_[static_cast<std::size_t>(number / kSonarsPerArray)].push_back(number);
  };
  for (const std::uint8_t from_one : numbers) {
    if (from_one > 0) add(from_one - 1);
  }
  for (int number = 0; numbers.empty() && number < static_cast<int>(kMaxSonars); ++number) add(number);
  next_.fill(0);
}

void SonarRing::advance(TimeNs t_ns, const Pose2& robot_in_world) {
  if (t_ns < t_next_ns_) return;
  t_next_ns_ = std::max(t_next_ns_, t_ns - cycle_ns_) + cycle_ns_;
  for (std::size_t array = 0; array < order_.size(); ++array) {
    if (!enabled_[array] || order_[array].empty()) continue;
    fire(order_[array][next_[array]], robot_in_world);
    next_[array] = (next_[array] + 1) % order_[array].size();
  }
}

std::vector<SonarReading> SonarRing::take_readings() {
  return std::exchange(readings_, {});
}

void SonarRing::fire(int number, const Pose2& robot_in_world) {
  const Pose2& mount = robot_.sonars[static_cast<std::size_t>(number)];
  const double c = std::cos(robot_in_world.heading_rad);
  const double s = std::sin(robot_in_world.heading_rad);
  const Pose2 sensor{robot_in_world.x_m + c * mount.x_m - s * mount.y_m,
                     robot_in_world.y_m + s * mount.x_m + c * mount.y_m,
                     robot_in_world.heading_rad + mount.heading_rad};
  double range_m = range_m_ ? range_m_(sensor) : kFarthest_m;
  if (!(range_m < kFarthest_m)) range_m = kFarthest_m;
  range_m = std::max(range_m, kNearest_m);
  readings_.push_back({static_cast<std::uint8_t>(number),
                       static_cast<std::uint16_t>(std::lround(range_m * 1000.0 / mm_per_range_unit_))});
}

}  // namespace heel::sim
