// The table of the daemon's threads: name, rate, priority, core, deadline and memory; and how a thread
// applies its row. Every thread of heeld has a row, and a test holds the running heeld to it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/config.h"
#include "heel/time.h"

namespace heel {

enum class ThreadRole : std::uint8_t {
  Main,
  Capture,
  Vision,
  Control,
  Link,
  Telemetry,
  Operator,
  Settings,
  View,
  Mqtt,
  Log
};

struct ThreadPlan {
  ThreadRole role = ThreadRole::Telemetry;
  const char* name = "";   ///< as `ps -T` shows it; at most 15 characters
  const char* does = "";   ///< for the manual
  double rate_hz = 0.0;    ///< of its loop; capture and vision follow the camera; 0: when there is work
  int priority = 0;        ///< SCHED_FIFO priority, 1…99; 0: not a real-time thread
  int core = -1;           ///< it runs on this processor core alone; −1: on any
  TimeNs deadline_ns = 0;  ///< the loop body must end within this time of its start; 0: none
  bool hot = false;        ///< after start it does not allocate, lock, format text or cause a page fault
};

inline constexpr std::size_t kThreads = 11;
/// In the order of ThreadRole.
using Schedule = std::array<ThreadPlan, kThreads>;

/// Of every thread that the process starts. The stages use less than a quarter of it; the kernel's usual 8 MB
/// would be locked in memory as a whole.
inline constexpr std::size_t kThreadStackBytes = std::size_t{1} << 20;

/// The table with the configured rates, priorities and cores.
Schedule make_schedule(const Config& config);
const ThreadPlan& plan_of(const Schedule& schedule, ThreadRole role);

/// The kernel's answer to a thread's request for its priority and its core.
struct ThreadEntry {
  bool realtime = false;  ///< SCHED_FIFO at the planned priority is in force
  int error = 0;          ///< errno of a refused priority; 0: granted, or not requested
  int core_error = 0;     ///< errno of a refused core; 0: granted, or not requested
};

/// The first call of each thread: sets its name, requests its core and its priority (when `realtime`), makes
/// its timers exact, and writes to its stack so that it causes no page faults later. After a refusal the
/// thread has ordinary scheduling, or any core, and can go on.
ThreadEntry enter_thread(const ThreadPlan& plan, bool realtime);

/// For a thread with ordinary scheduling that has no ThreadPlan at hand.
void name_thread(ThreadRole role);

/// To be called once, before the process starts a thread: small stacks, also for the threads of libraries;
/// one heap, because each thread's own would reserve 64 MB; and freed memory stays with the process, so that
/// no later allocation of an ordinary thread waits for the kernel to map it again.
void prepare_process_memory();

/// Locks all memory of the process, present and future. To be called once, after the configuration has been
/// read and before the threads start. Returns 0, or the errno of a refusal; the process can go on without.
int lock_process_memory();

}  // namespace heel
