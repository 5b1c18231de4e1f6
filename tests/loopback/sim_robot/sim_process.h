// Runs heel-sim as a child process and reads what it prints.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace heel::sim::test {

class SimProcess {
 public:
  explicit SimProcess(const std::vector<std::string>& arguments);
  SimProcess(const SimProcess&) = delete;
  SimProcess& operator=(const SimProcess&) = delete;
  ~SimProcess();  ///< ends it when it still runs

  /// Waits until it has printed `text`; false after `timeout_s`.
  bool wait_for(const std::string& text, double timeout_s = 10.0);
  void signal(int number) const;
  /// Waits for its end; its exit status, −1 when a signal ended it or `timeout_s` passed.
  int wait_for_exit(double timeout_s = 10.0);
  const std::string& printed() const { return printed_; }  ///< both stdout and stderr

 private:
  void read_output(double timeout_s);

  pid_t pid_ = -1;
  int output_ = -1;
  std::string printed_;
};

double now_s();
void sleep_s(double seconds);

}  // namespace heel::sim::test
