#include "robot/p3at_geometry.h"

#include <cstddef>
#include <numbers>

namespace heel {
namespace {

struct SonarMount {
  double x_m, y_m, heading_deg;
};
/// The left half of the front array, from left to right. Each array is symmetric about the x axis.
constexpr SonarMount kFrontLeft[] = {
    {0.147, 0.136, 90}, {0.193, 0.119, 50}, {0.227, 0.079, 30}, {0.245, 0.027, 10}};
/// The right half of the rear array, from right to left: it sits 3 to 4 mm nearer to the centre.
constexpr SonarMount kRearRight[] = {
    {-0.144, -0.136, -90}, {-0.189, -0.119, -130}, {-0.223, -0.079, -150}, {-0.241, -0.027, -170}};

SonarMount mount_of_sonar(std::size_t number) {
  constexpr std::size_t kHalf = 4;
  const bool rear = number >= 2 * kHalf;
  const std::size_t place = number % (2 * kHalf);
  if (place < kHalf) return (rear ? kRearRight : kFrontLeft)[place];
  const SonarMount& mirrored = (rear ? kRearRight : kFrontLeft)[2 * kHalf - 1 - place];
  return {mirrored.x_m, -mirrored.y_m, -mirrored.heading_deg};
}

}  // namespace

RobotGeometry p3at_geometry() {
  RobotGeometry geometry;
  geometry.centre_to_bumper_m = 0.313;
  geometry.half_width_m = 0.25;
  for (std::size_t number = 0; number < kSonars; ++number) {
    const SonarMount mount = mount_of_sonar(number);
    geometry.sonars[number] = {mount.x_m, mount.y_m, mount.heading_deg * std::numbers::pi / 180.0};
  }
  return geometry;
}

}  // namespace heel
