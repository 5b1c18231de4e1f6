// Runs the built `heel` and keeps what it said.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace heel::test {

struct Outcome {
  int status = -1;  ///< exit status; −1 when it did not exit by itself
  std::string out;
  std::string err;
};

inline std::string quoted(const std::string& argument) {
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

inline Outcome run_heel(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
  std::string command = quoted(HEEL_PROGRAM);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command += " >" + quoted(folder.file("stdout")) + " 2>" + quoted(folder.file("stderr")) + " </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder.file("stdout")),
          read_text(folder.file("stderr"))};
}

}  // namespace heel::test
