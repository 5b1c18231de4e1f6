#include "daemon/thread_table.h"

#include <fmt/format.h>

#include "realtime/schedule.h"

namespace heel {
namespace {

std::string rate_text(double rate_hz) {
  return rate_hz > 0.0 ? fmt::format("{:g} Hz", rate_hz) : "when there is work";
}

std::string row(const ThreadPlan& plan) {
  const bool realtime = plan.priority > 0;
  return fmt::format(
      "| `{}` | {} | {} | {} | {} | {} | {} | {} | {} |\n", plan.name, plan.does, rate_text(plan.rate_hz),
      realtime ? "`SCHED_FIFO`" : "`SCHED_OTHER`", realtime ? fmt::to_string(plan.priority) : "-",
      plan.core >= 0 ? fmt::to_string(plan.core) : "any",
      plan.deadline_ns > 0 ? fmt::format("{:.3g} ms", 1e-6 * static_cast<double>(plan.deadline_ns)) : "-",
      plan.role == ThreadRole::Main ? "of the process" : fmt::format("{} kB", kThreadStackBytes / 1024),
      plan.hot ? "locked; no allocation, no page fault after start" : "locked");
}

}  // namespace

std::string thread_table_text(const Config& config) {
  std::string text =
      "| thread | does | rate | policy | priority | core | ends within | stack | memory |\n"
      "|---|---|---|---|---:|---|---|---|---|\n";
  for (const ThreadPlan& plan : make_schedule(config)) text += row(plan);
  return text;
}

}  // namespace heel
