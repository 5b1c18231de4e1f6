// A running heel-sim, and what the packets of its robot say.
#pragma once

#include <string>
#include <vector>

#include "loopback/heel-sim/raw_client.h"
#include "support/process.h"

namespace heel::test {

inline constexpr int kOpen = 1, kClose = 2, kEnable = 4, kVel = 11, kConfig = 18, kHostBaud = 50;

inline bool motors_on(const Bytes& sip) {
  return (sip.at(16) & 1) != 0;
}

/// A running heel-sim; `address` is what it announced.
struct RunningSim {
  RunningSim(const std::string& robot, std::vector<std::string> options = {})
      : process(arguments(robot, options)) {
    if (!process.says("\n")) return;
    const std::string line = process.output();
    const std::size_t start = line.find("ready at ");
    if (start != std::string::npos) address = line.substr(start + 9, line.find('\n', start) - start - 9);
  }
  static std::vector<std::string> arguments(const std::string& robot, std::vector<std::string> options) {
    options.insert(options.begin(), {built_program("heel-sim"), "--robot", robot});
    return options;
  }

  Process process;
  std::string address;
};

}  // namespace heel::test
