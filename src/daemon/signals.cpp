#include "daemon/signals.h"

#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <string>

#include "heel/error.h"

namespace heel {

Signals::Signals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set, number);
  const int error = pthread_sigmask(SIG_BLOCK, &set, nullptr);
  if (error != 0) throw Error(std::string("signals cannot be blocked: ") + std::strerror(error));
  fd_ = signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
  if (fd_ < 0) throw Error(std::string("signals cannot be read: ") + std::strerror(errno));
  std::signal(SIGPIPE, SIG_IGN);  // writing to a closed connection gives an error code instead
}

Signals::~Signals() {
  close(fd_);
}

Signal Signals::wait(TimeNs timeout_ns) {
  pollfd readable{fd_, POLLIN, 0};
  if (poll(&readable, 1, static_cast<int>(timeout_ns / kNsPerMs)) <= 0) return Signal::None;
  signalfd_siginfo info{};
  if (read(fd_, &info, sizeof info) != sizeof info) return Signal::None;
  return info.ssi_signo == SIGHUP ? Signal::Reload : Signal::Stop;
}

}  // namespace heel
