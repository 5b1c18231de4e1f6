// The local socket that operators connect to: made, served by one process only, and removed at the end.
#pragma once

#include <sys/types.h>

#include <string>

#include "heel/time.h"

namespace heel {

class LocalSocket {
 public:
  static constexpr TimeNs kAcceptPause_ns = 100 * kNsPerMs;

  /// Listens at `path`, for the user and the group of this process. A socket that a process left which is
  /// gone is replaced. Throws heel::Error with one line when another process serves it, when something else
  /// has that name, or when it cannot be made.
  explicit LocalSocket(const std::string& path);
  /// Removes the file, unless another process has replaced it.
  ~LocalSocket();
  LocalSocket(LocalSocket&& other) noexcept;
  LocalSocket(const LocalSocket&) = delete;
  LocalSocket& operator=(const LocalSocket&) = delete;

  int fd() const { return fd_; }
  /// The connection of a client, which does not block; -1: none waits, or none can be accepted, as without a
  /// free descriptor. Then the next one is accepted kAcceptPause_ns later.
  int accept(TimeNs now_ns);
  bool pauses(TimeNs now_ns) const { return now_ns < t_accept_ns_; }
  const std::string& path() const { return path_; }

 private:
  void bind_and_listen();

  std::string path_;
  int fd_ = -1;
  dev_t device_ = 0;
  ino_t inode_ = 0;
  TimeNs t_accept_ns_ = 0;  // none is accepted before
  bool warned_ = false;
};

}  // namespace heel
