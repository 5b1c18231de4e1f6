// The local socket that operators connect to: made, served by one process only, and removed at the end.
#pragma once

#include <sys/types.h>

#include <string>

namespace heel {

class LocalSocket {
 public:
  /// Listens at `path`, for the user and the group of this process. A socket that a process left which is
  /// gone is replaced. Throws heel::Error with one line when another process serves it, when something else
  /// has that name, or when it cannot be made.
  explicit LocalSocket(const std::string& path);
  /// Removes the file, unless another process has replaced it.
  ~LocalSocket();
  LocalSocket(const LocalSocket&) = delete;
  LocalSocket& operator=(const LocalSocket&) = delete;

  int fd() const { return fd_; }
  const std::string& path() const { return path_; }

 private:
  void bind_and_listen();

  std::string path_;
  int fd_ = -1;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

}  // namespace heel
