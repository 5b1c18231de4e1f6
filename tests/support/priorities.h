// Whether the kernel grants this process real-time priorities, and how to prevent it: for tests of both
// cases.
#pragma once

#include <linux/capability.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <thread>

namespace heel::test {

/// What the kernel answers to a thread of this process that asks for SCHED_FIFO at `priority`: 0 or an errno.
inline int answer_to_fifo_request(int priority) {
  int error = 0;
  std::jthread([&] {
    sched_param parameters{};
    parameters.sched_priority = priority;
    error = sched_setscheduler(0, SCHED_FIFO, &parameters) == 0 ? 0 : errno;
  }).join();
  return error;
}

/// While it lives, the process's resource limit allows no real-time priority.
class NoPriorityLimit {
 public:
  NoPriorityLimit() {
    getrlimit(RLIMIT_RTPRIO, &before_);
    const rlimit none{.rlim_cur = 0, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_RTPRIO, &none);
  }
  NoPriorityLimit(const NoPriorityLimit&) = delete;
  NoPriorityLimit& operator=(const NoPriorityLimit&) = delete;
  ~NoPriorityLimit() { setrlimit(RLIMIT_RTPRIO, &before_); }

 private:
  rlimit before_{};
};

/// Takes CAP_SYS_NICE from the calling thread and from the threads that it starts later; other threads keep
/// it.
inline void drop_sys_nice() {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> sets{};
  if (syscall(SYS_capget, &header, sets.data()) != 0) throw std::runtime_error("capget failed");
  sets[CAP_SYS_NICE / 32].effective &= ~(1u << (CAP_SYS_NICE % 32));
  if (syscall(SYS_capset, &header, sets.data()) != 0) throw std::runtime_error("capset failed");
}

}  // namespace heel::test
