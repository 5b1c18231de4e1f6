// The one table of the daemon's threads: name, rate, priority, deadline. What a thread does about it on
// entry.
#pragma once

#include <array>
#include <cstdint>

#include "core/config.h"
#include "heel/time.h"

namespace heel {

enum class ThreadRole : std::uint8_t { Capture, Vision, Control, Telemetry };

struct ThreadPlan {
  ThreadRole role = ThreadRole::Telemetry;
  const char* name = "";   ///< as shown by ps -T; at most 15 characters
  double rate_hz = 0.0;    ///< how often its body runs; capture and vision follow the camera
  int priority = 0;        ///< SCHED_FIFO priority, 1…99; 0: not a real-time thread
  TimeNs deadline_ns = 0;  ///< the body, once begun, is to be over within this time
};

using Schedule = std::array<ThreadPlan, 4>;

/// The table, with the configured rates and priorities filled in.
Schedule make_schedule(const Config& config);
const ThreadPlan& plan_of(const Schedule& schedule, ThreadRole role);

/// What became of asking for real time.
struct ThreadEntry {
  bool realtime = false;  ///< SCHED_FIFO at the planned priority is on
  int error = 0;          ///< errno of the refusal; 0: granted, or not asked for
};

/// The first call of each thread: names it, asks for its priority (when `realtime`), lets its timers be
/// exact, and touches its stack so that it causes no page faults later. A refusal is logged and the thread
/// goes on.
ThreadEntry enter_thread(const ThreadPlan& plan, bool realtime);

/// Locks all memory of the process, present and future. Call once, after configuration and before the threads
/// start. False: refused, which is logged; the process goes on.
bool lock_process_memory();

}  // namespace heel
