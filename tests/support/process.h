// Child processes with their output, and systemd's end of the notification socket.
#pragma once

#include <sys/types.h>

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace heel::test {

/// How long a test waits for what must happen, however busy the machine is. Only a test that fails waits this
/// long.
inline constexpr double kPatience_s = 120.0;
/// The same for a program that does its work and ends.
inline constexpr double kProgramPatience_s = 900.0;

class Process {
 public:
  /// Starts `argv`; standard output and error go to `log_path`, by default a file that is removed with this
  /// object.
  explicit Process(const std::vector<std::string>& argv, const std::string& log_path = {},
                   const std::map<std::string, std::string>& environment = {});
  /// A child of this program that runs `body` and ends with status 0. Call it before the test starts threads.
  explicit Process(const std::function<void()>& body);
  /// Kills the child if it still runs.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  bool running();
  /// Exit status, or −signal; −1000 when it has not ended within `timeout_s`.
  int wait(double timeout_s = kPatience_s);

  /// What it has written so far.
  std::string output() const;
  /// True as soon as the output holds `text`, false after the timeout or when it ended without.
  bool says(const std::string& text, double timeout_s = kPatience_s);

 private:
  void start(const std::function<void()>& body);

  pid_t pid_ = -1;
  std::string log_path_;
  bool log_is_ours_ = false;
  bool ended_ = false;
  int status_ = 0;
};

/// The path of a program of this build: it is in the folder of the test that runs.
std::string built_program(const std::string& name);

/// What a program that ran to its end has left.
struct Outcome {
  int status = -1;  ///< exit status, or −signal; −1000 when it was killed because it did not end
  std::string out;
  std::string err;
};

/// Runs `argv` to its end with empty standard input. Standard output goes to `out_path` where one is given.
Outcome run_program(const std::vector<std::string>& argv, const std::string& out_path = {});

/// Receives the messages of a service to systemd, sd_notify(3).
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path);
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  const std::string& path() const { return path_; }
  /// Every message so far, in order.
  std::vector<std::string> messages();
  bool receives(const std::string& text, double timeout_s = kPatience_s);

 private:
  void read_until_closed();

  std::string path_;
  int fd_ = -1;
  std::mutex mutex_;
  std::vector<std::string> messages_;  // guarded by mutex_
  std::thread reader_;                 // reads all the time, as systemd does
};

void sleep_s(double seconds);
double monotonic_s();

/// Polls until `condition` holds; false after the timeout.
template <typename Condition>
bool eventually(Condition condition, double timeout_s = kPatience_s) {
  for (const double end_s = monotonic_s() + timeout_s; monotonic_s() < end_s; sleep_s(0.01)) {
    if (condition()) return true;
  }
  return condition();
}

}  // namespace heel::test
