// The table of the daemon's threads: name, rate, priority and deadline; and how a thread applies its row.
#pragma once

#include <array>
#include <cstdint>

#include "core/config.h"
#include "heel/time.h"

namespace heel {

enum class ThreadRole : std::uint8_t { Capture, Vision, Control, Telemetry, Operator, Settings };

struct ThreadPlan {
  ThreadRole role = ThreadRole::Telemetry;
  const char* name = "";   ///< as `ps -T` shows it; at most 15 characters
  double rate_hz = 0.0;    ///< of its loop; capture and vision follow the camera; 0: when there is work
  int priority = 0;        ///< SCHED_FIFO priority, 1…99; 0: not a real-time thread
  TimeNs deadline_ns = 0;  ///< the loop body must end within this time of its start; 0: none
};

using Schedule = std::array<ThreadPlan, 6>;

/// The table with the configured rates and priorities.
Schedule make_schedule(const Config& config);
const ThreadPlan& plan_of(const Schedule& schedule, ThreadRole role);

/// The kernel's answer to a thread's request for its priority.
struct ThreadEntry {
  bool realtime = false;  ///< SCHED_FIFO at the planned priority is in force
  int error = 0;          ///< errno of a refusal; 0: granted, or not requested
};

/// The first call of each thread: sets its name, requests its priority (when `realtime`), makes its timers
/// exact, and writes to its stack so that it causes no page faults later. After a refusal the thread has
/// ordinary scheduling and can go on.
ThreadEntry enter_thread(const ThreadPlan& plan, bool realtime);

/// Locks all memory of the process, present and future. To be called once, after the configuration has been
/// read and before the threads start. Returns 0, or the errno of a refusal; the process can go on without.
int lock_process_memory();

}  // namespace heel
