// Which parameters the robot that answers is driven with: those of its subclass, or none.
#pragma once

#include <span>
#include <string_view>

#include "arcos/other_packets.h"
#include "heel/flow.h"

namespace heel {

/// robot.model that leaves the choice to the robot.
inline constexpr std::string_view kAnyModel = "auto";

/// `configured`: kAnyModel, or the subclass that the robot must have. A robot that does not say what it is
/// is taken for the configured one. Does not allocate.
RobotKind choose_model(const arcos::RobotIdentity& identity, std::string_view configured);

/// True: it must not be driven.
constexpr bool is_refused(ModelChoice choice) {
  return choice == ModelChoice::Unknown || choice == ModelChoice::Conflict || choice == ModelChoice::Nameless;
}

}  // namespace heel
