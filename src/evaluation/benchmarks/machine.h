// The machine a benchmark ran on, as far as it bears on the times.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace heel::evaluation {

struct Machine {
  std::string cpu;  ///< as the kernel names it
  unsigned cores = 0;
  std::string simd;        ///< the instruction set Highway has chosen
  std::string opencv;      ///< version
  double load_1min = 0.0;  ///< load average when asked
};

Machine this_machine();
nlohmann::ordered_json json_of(const Machine& machine);

}  // namespace heel::evaluation
