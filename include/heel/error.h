// The one failure style outside the hot path: an exception whose text is a single line for a person.
// After the threads have started nothing throws: results carry a named reason instead (see flow.h).
#pragma once

#include <stdexcept>
#include <string>

namespace heel {

/// Bad input, said in one line that names the thing, the place and what was expected, e.g.
/// "heel.toml:12:8: control.gain_yaw: 'fast' is not a number (expected 0…10, 1/s)".
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& line) : std::runtime_error(line) {}
};

}  // namespace heel
