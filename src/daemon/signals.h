// Signals as input of the main thread: blocked in every thread, and read from a file descriptor.
#pragma once

#include "heel/time.h"

namespace heel {

enum class Signal : unsigned char { None, Stop, Reload };

class Signals {
 public:
  /// Blocks SIGTERM, SIGINT and SIGHUP in this thread and all threads it starts later, and ignores SIGPIPE.
  /// Throws heel::Error.
  Signals();
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  /// The next signal, or None after the timeout.
  Signal wait(TimeNs timeout_ns);

 private:
  int fd_ = -1;
};

}  // namespace heel
