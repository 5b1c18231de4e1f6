// Child processes with their output in a file, and systemd's end of the notification socket.
#pragma once

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace heel::test {

class Process {
 public:
  /// Starts `argv`; standard output and error go to `log_path`, by default a file that goes with this object.
  explicit Process(const std::vector<std::string>& argv, const std::string& log_path = {},
                   const std::map<std::string, std::string>& environment = {});
  /// Kills what is still running.
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const;
  bool running();
  /// Exit status, or −signal; −1000 when it has not ended within `timeout_s`.
  int wait(double timeout_s = 10.0);

  /// What it has written so far.
  std::string output() const;
  /// True as soon as the output holds `text`, false after the timeout or when it ended without.
  bool says(const std::string& text, double timeout_s = 10.0);

 private:
  pid_t pid_ = -1;
  std::string log_path_;
  bool log_is_ours_ = false;
  bool ended_ = false;
  int status_ = 0;
};

/// Receives what sd_notify sends.
class NotifySocket {
 public:
  explicit NotifySocket(const std::string& path);
  ~NotifySocket();
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  const std::string& path() const { return path_; }
  /// Every message so far, in order.
  const std::vector<std::string>& messages();
  bool receives(const std::string& text, double timeout_s);

 private:
  std::string path_;
  int fd_ = -1;
  std::vector<std::string> messages_;
};

/// Polls until `condition` holds; false after the timeout.
template <typename Condition>
bool eventually(Condition condition, double timeout_s);

void sleep_s(double seconds);
double monotonic_s();

template <typename Condition>
bool eventually(Condition condition, double timeout_s) {
  for (const double end_s = monotonic_s() + timeout_s; monotonic_s() < end_s; sleep_s(0.01)) {
    if (condition()) return true;
  }
  return condition();
}

std::string content_of(const std::string& path);

}  // namespace heel::test
