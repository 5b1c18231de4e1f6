#include "daemon/loop_thread.h"

#include <spdlog/spdlog.h>

#include <cstring>
#include <exception>

namespace heel {
namespace {

void log_entry(const ThreadPlan& plan, const ThreadEntry& entry) {
  if (entry.core_error != 0) {
    spdlog::warn("thread {}: processor core {} refused ({}); it runs on any core; see runtime.core_{}",
                 plan.name, plan.core, std::strerror(entry.core_error), plan.name + std::strlen("heel-"));
  }
  if (entry.realtime) {
    spdlog::debug("thread {}: real-time priority {} granted", plan.name, plan.priority);
  } else if (entry.error != 0) {
    spdlog::warn(
        "thread {}: real-time priority {} refused ({}); it runs with ordinary scheduling; "
        "set LimitRTPRIO={} or grant CAP_SYS_NICE",
        plan.name, plan.priority, std::strerror(entry.error), plan.priority);
  }
}

}  // namespace

std::thread start_loop_thread(const ThreadPlan& plan, bool realtime, std::function<void()> loop,
                              std::atomic<bool>& failed) {
  return std::thread([plan, realtime, loop = std::move(loop), &failed] {
    try {
      log_entry(plan, enter_thread(plan, realtime));
      loop();
    } catch (const std::exception& error) {
      spdlog::critical("thread {} failed: {}; heeld stops", plan.name, error.what());
      failed = true;
    }
  });
}

}  // namespace heel
