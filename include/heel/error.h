/// \file
/// The exception by which heel reports bad input before its threads start.
///
/// - Convention: constructors and loaders throw heel::Error. After the threads have started nothing throws:
///   results carry a named reason instead (heel::PoseReason, heel::HomographyStatus, heel::PlaneMotionCase).
#pragma once

#include <stdexcept>
#include <string>

namespace heel {

/// Bad input. what() is one line that names the thing, the place and what was expected, e.g.
/// "heel.toml:12:8: control.gain_yaw: 'fast' is not a number (expected 0…10, 1/s)".
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& line) : std::runtime_error(line) {}
};

}  // namespace heel
