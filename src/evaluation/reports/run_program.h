// Runs another program and waits for its end; no shell.
#pragma once

#include <string>
#include <vector>

namespace heel::evaluation {

struct ProgramEnd {
  int start_error = 0;     ///< errno when it could not be started; 0: it was
  int status = -1;         ///< exit status; −signal when a signal ended it
  std::string complaints;  ///< what it wrote to standard error
};

/// `arguments[0]` is the program's path. It reads nothing, and what it writes to standard output is dropped.
ProgramEnd run_program(const std::vector<std::string>& arguments);

}  // namespace heel::evaluation
