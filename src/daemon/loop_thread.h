// A thread that runs one of the daemon's loops under its row of the schedule.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "realtime/schedule.h"

namespace heel {

/// Starts the thread: it takes the name and priority of `plan`, logs what the kernel granted, and runs
/// `loop`. An exception that leaves `loop` is logged, ends the thread and sets `failed`, which must outlive
/// the thread.
std::thread start_loop_thread(const ThreadPlan& plan, bool realtime, std::function<void()> loop,
                              std::atomic<bool>& failed);

}  // namespace heel
