#include "sim/robot/sonar.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace heel::sim {
namespace {

constexpr double kFarthest_m = 5.0;  // also reported without an echo
constexpr double kNearest_m = 0.15;

struct Mount {
  double x_mm, y_mm, heading_deg;
};
constexpr std::array<Mount, kSonarsPerArray / 2> kFrontLeft{
    {{147, 136, 90}, {193, 119, 50}, {227, 79, 30}, {245, 27, 10}}};
constexpr std::array<Mount, kSonarsPerArray / 2> kRearRight{
    {{-144, -136, -90}, {-189, -119, -130}, {-223, -79, -150}, {-241, -27, -170}}};

}  // namespace

Pose2 sonar_mount(int number) {
  const bool rear = number >= kSonarsPerArray;
  const int place = number % kSonarsPerArray;
  const bool mirrored = place >= kSonarsPerArray / 2;
  const auto row = static_cast<std::size_t>(mirrored ? kSonarsPerArray - 1 - place : place);
  const Mount& mount = (rear ? kRearRight : kFrontLeft)[row];
  const double side = mirrored ? -1.0 : 1.0;
  return {mount.x_mm * 1e-3, side * mount.y_mm * 1e-3, side * mount.heading_deg * std::numbers::pi / 180.0};
}

SonarRing::SonarRing() {
  set_polling({});
}

void SonarRing::set_polling(std::span<const std::uint8_t> numbers) {
  for (std::vector<int>& order : order_) order.clear();
  for (const std::uint8_t from_one : numbers) {
    if (from_one < 1 || from_one > kSonarCount) continue;
    const int number = from_one - 1;
    order_[static_cast<std::size_t>(number / kSonarsPerArray)].push_back(number);
  }
  for (int number = 0; numbers.empty() && number < kSonarCount; ++number) {
    order_[static_cast<std::size_t>(number / kSonarsPerArray)].push_back(number);
  }
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
  const Pose2 mount = sonar_mount(number);
  const double c = std::cos(robot_in_world.heading_rad);
  const double s = std::sin(robot_in_world.heading_rad);
  const Pose2 sensor{robot_in_world.x_m + c * mount.x_m - s * mount.y_m,
                     robot_in_world.y_m + s * mount.x_m + c * mount.y_m,
                     robot_in_world.heading_rad + mount.heading_rad};
  double range_m = range_m_ ? range_m_(sensor) : kFarthest_m;
  if (!(range_m < kFarthest_m)) range_m = kFarthest_m;
  range_m = std::max(range_m, kNearest_m);
  readings_.push_back(
      {static_cast<std::uint8_t>(number), static_cast<std::uint16_t>(std::lround(range_m * 1000.0))});
}

}  // namespace heel::sim
