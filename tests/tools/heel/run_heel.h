// Runs the built `heel` and keeps its output.
#pragma once

#include <string>
#include <vector>

#include "support/process.h"
#include "support/temporary_folder.h"

namespace heel::test {

inline Outcome run_heel(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), test::built_program("heel"));
  return run_program(arguments);
}

}  // namespace heel::test
