#include "realtime/schedule.h"

#include <linux/capability.h>
#include <malloc.h>
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

// Sanitizers make frames of functions several times as large.
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
constexpr std::size_t kStackBytes = 8 * kThreadStackBytes;
#else
constexpr std::size_t kStackBytes = kThreadStackBytes;
#endif

constexpr double kTelemetryRate_Hz = 20.0;
// Written on entry; more than any stage uses.
constexpr std::size_t kPrefaultedStackBytes = 256 * 1024;
constexpr int kKeptFreeBytes = 32 << 20;
constexpr int kLargestOnHeapBytes = 16 << 20;

TimeNs period_ns(double rate_hz) {
  return rate_hz > 0.0 ? ns_from_seconds(1.0 / rate_hz) : 0;
}

[[gnu::noinline]] void prefault_stack() {
  // One byte of each page is written, not all. NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
  std::array<volatile char, kPrefaultedStackBytes> stack;
  const long page_bytes = sysconf(_SC_PAGESIZE);
  for (std::size_t i = 0; i < stack.size(); i += static_cast<std::size_t>(page_bytes)) stack[i] = 0;
}

int move_to_core(int core) {
  if (core >= CPU_SETSIZE) return EINVAL;
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(static_cast<unsigned>(core), &cores);
  return pthread_setaffinity_np(pthread_self(), sizeof cores, &cores);
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
  const double frames_hz = config.camera.rate_hz, ticks_hz = config.control.rate_hz;
  // Control before capture before vision: the wheels must never wait for an image.
  return {{
      {.role = ThreadRole::Main,
       .name = "heeld",
       .does = "loads the configuration, starts and stops the others, answers systemd",
       .rate_hz = 10.0},
      {.role = ThreadRole::Capture,
       .name = "heel-capture",
       .does = "waits for frames, converts them to grey, publishes the newest",
       .rate_hz = frames_hz,
       .priority = rt.priority_capture,
       .core = rt.core_capture,
       .deadline_ns = frame_ns,
       .hot = true},
      {.role = ThreadRole::Vision,
       .name = "heel-vision",
       .does = "estimates the pose in the newest frame",
       .rate_hz = frames_hz,
       .priority = rt.priority_vision,
       .core = rt.core_vision,
       .deadline_ns = frame_ns,
       .hot = true},
      {.role = ThreadRole::Control,
       .name = "heel-control",
       .does = "reads the robot's line, predicts, decides, commands",
       .rate_hz = ticks_hz,
       .priority = rt.priority_control,
       .core = rt.core_control,
       .deadline_ns = tick_ns,
       .hot = true},
      {.role = ThreadRole::Link,
       .name = "heel-link",
       .does = "opens and closes the robot's line, which may take long"},
      {.role = ThreadRole::Telemetry,
       .name = "heel-telemetry",
       .does = "drains the queues of records, writes the recording, logs events",
       .rate_hz = kTelemetryRate_Hz,
       .deadline_ns = period_ns(kTelemetryRate_Hz)},
      {.role = ThreadRole::Operator, .name = "heel-operator", .does = "serves the operators' socket"},
      {.role = ThreadRole::Settings,
       .name = "heel-settings",
       .does = "checks, applies and saves new values of the configuration"},
      {.role = ThreadRole::View,
       .name = "heel-view",
       .does = "serves the page of view.address, where that is set"},
      {.role = ThreadRole::Mqtt,
       .name = "heel-mqtt",
       .does = "publishes the status to the broker of mqtt.address, where that is set"},
      {.role = ThreadRole::Log, .name = "heel-log", .does = "writes the log"},
  }};
}

const ThreadPlan& plan_of(const Schedule& schedule, ThreadRole role) {
  return schedule[static_cast<std::size_t>(role)];
}

ThreadEntry enter_thread(const ThreadPlan& plan, bool realtime) {
  pthread_setname_np(pthread_self(), plan.name);
  prefault_stack();
  // By default the kernel may lengthen a sleep of an ordinary thread by 50 µs to save wake-ups.
  prctl(PR_SET_TIMERSLACK, 1UL);

  ThreadEntry entry;
  if (!realtime) return entry;
  if (plan.core >= 0) entry.core_error = move_to_core(plan.core);
  if (plan.priority <= 0) return entry;
  sched_param parameters{};
  parameters.sched_priority = plan.priority;
  // Threads and processes that it starts must not inherit the priority.
  entry.error = pthread_setschedparam(pthread_self(), SCHED_FIFO | SCHED_RESET_ON_FORK, &parameters);
  entry.realtime = entry.error == 0;
  return entry;
}

void name_thread(ThreadRole role) {
  static const Schedule schedule = make_schedule({});
  pthread_setname_np(pthread_self(), plan_of(schedule, role).name);
}

void prepare_process_memory() {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, kStackBytes);
  pthread_setattr_default_np(&attributes);
  pthread_attr_destroy(&attributes);
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_TRIM_THRESHOLD, kKeptFreeBytes);
  mallopt(M_MMAP_THRESHOLD, kLargestOnHeapBytes);
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
