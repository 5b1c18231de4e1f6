// The shape of the robot as the control stage needs it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/pose2.h"
#include "heel/flow.h"

namespace heel {

struct RobotGeometry {
  double front_m = 0.0;  ///< along x, from the point about which it turns to the front bumper
  double rear_m = 0.0;   ///< and to the rear one; positive
  double half_width_m = 0.0;
  /// Where each sonar sits in the robot frame; the heading is the middle of its beam.
  std::array<Pose2, kMaxSonars> sonars{};
  std::uint32_t fitted = 0;  ///< bit i: there is a sonar i
  std::uint32_t ahead = 0;   ///< bit i: it sits in front and looks ahead or to the side
  bool has_sonar(std::size_t number) const { return number < kMaxSonars && (fitted >> number & 1u) != 0; }
  bool looks_ahead(std::size_t number) const { return number < kMaxSonars && (ahead >> number & 1u) != 0; }
};
static_assert(kMaxSonars <= 32, "RobotGeometry keeps a bit for each");

}  // namespace heel
