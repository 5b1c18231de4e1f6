#include "realtime/schedule.h"

#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace heel {

namespace {

constexpr double kTelemetryRate_Hz = 20.0;
// Written on entry; more than any stage uses, far less than the 8 MB of a thread's stack.
constexpr std::size_t kPrefaultedStackBytes = 256 * 1024;

TimeNs period_ns(double rate_hz) {
  return rate_hz > 0.0 ? ns_from_seconds(1.0 / rate_hz) : 0;
}

[[gnu::noinline]] void prefault_stack() {
  // One byte of each page is written, not all. NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
  std::array<volatile char, kPrefaultedStackBytes> stack;
  const long page_bytes = sysconf(_SC_PAGESIZE);
  for (std::size_t i = 0; i < stack.size(); i += static_cast<std::size_t>(page_bytes)) stack[i] = 0;
}

bool has_capability(unsigned capability) {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data{};
  if (syscall(SYS_capget, &header, data.data()) != 0) return false;
  return ((data[capability / 32].effective >> (capability % 32)) & 1u) != 0;
}

}  // namespace

Schedule make_schedule(const Config& config) {
  const TimeNs frame_ns = period_ns(config.camera.rate_hz);
  const TimeNs tick_ns = period_ns(config.control.rate_hz);
  const RuntimeConfig& rt = config.runtime;
  // Control before capture before vision: the wheels must never wait for an image.
  return {{
      // role                  name              rate                     priority             deadline
      {ThreadRole::Capture, "heel-capture", config.camera.rate_hz, rt.priority_capture, frame_ns},
      {ThreadRole::Vision, "heel-vision", config.camera.rate_hz, rt.priority_vision, frame_ns},
      {ThreadRole::Control, "heel-control", config.control.rate_hz, rt.priority_control, tick_ns},
      {ThreadRole::Telemetry, "heel-telemetry", kTelemetryRate_Hz, 0, period_ns(kTelemetryRate_Hz)},
      {ThreadRole::Operator, "heel-operator", 0.0, 0, 0},
      {ThreadRole::Settings, "heel-settings", 0.0, 0, 0},
  }};
}

const ThreadPlan& plan_of(const Schedule& schedule, ThreadRole role) {
  for (const ThreadPlan& plan : schedule) {
    if (plan.role == role) return plan;
  }
  return schedule.back();
}

ThreadEntry enter_thread(const ThreadPlan& plan, bool realtime) {
  pthread_setname_np(pthread_self(), plan.name);
  prefault_stack();
  // By default the kernel may lengthen a sleep of an ordinary thread by 50 µs to save wake-ups.
  prctl(PR_SET_TIMERSLACK, 1UL);

  ThreadEntry entry;
  if (!realtime || plan.priority <= 0) return entry;
  sched_param parameters{};
  parameters.sched_priority = plan.priority;
  // Threads and processes that it starts must not inherit the priority.
  entry.error = pthread_setschedparam(pthread_self(), SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters);
  entry.realtime = entry.error == 0;
  return entry;
}

int lock_process_memory() {
  // With a finite limit mlockall would succeed now, and every later allocation beyond the limit would fail.
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  const bool unlimited = limit.rlim_cur == RLIM_INFINITY || has_capability(CAP_IPC_LOCK);
  if (!unlimited) return EPERM;
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? 0 : errno;
}

}  // namespace heel
