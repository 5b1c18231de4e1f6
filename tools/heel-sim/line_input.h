// Lines from a descriptor, as they come, without waiting for them.
#pragma once

#include <string>
#include <vector>

namespace heel::sim {

class LineInput {
 public:
  /// The descriptor stays the caller's.
  explicit LineInput(int fd) : fd_(fd) {}
  /// The complete lines that have come since the last call, without their ends; empty ones are left out.
  std::vector<std::string> lines();

 private:
  bool read_more();

  int fd_;  ///< -1: it has ended
  std::string rest_;
};

}  // namespace heel::sim
