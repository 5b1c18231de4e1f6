// A program that runs beside this one, with its output in a file, until it is ended.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace heel::cli {

class BackgroundProgram {
 public:
  /// `arguments[0]` is the program's path. Throws heel::Error when it cannot be started.
  BackgroundProgram(const std::vector<std::string>& arguments, std::string log_file);
  /// Ends it by SIGTERM, or by SIGKILL when that takes longer than 5 s.
  ~BackgroundProgram();
  BackgroundProgram(const BackgroundProgram&) = delete;
  BackgroundProgram& operator=(const BackgroundProgram&) = delete;

  pid_t pid() const { return pid_; }
  /// What it has printed so far.
  std::string output() const;
  /// Waits until it has printed `text`. Throws heel::Error with the end of its output when it has not in
  /// time, or ends.
  void wait_for(const std::string& text, double timeout_s);
  /// Waits until it has ended with status 0. Throws heel::Error, likewise, when it has not in time.
  void wait_for_end(double timeout_s);
  /// Throws heel::Error, likewise, when it has ended.
  void require_running();

 private:
  [[noreturn]] void fail(const std::string& what) const;

  const std::string name_;
  const std::string log_file_;
  pid_t pid_ = -1;
  bool ended_ = false;
};

}  // namespace heel::cli
