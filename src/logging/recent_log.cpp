#include "logging/recent_log.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace heel {

std::vector<LoggedLine> RecentLog::after(std::uint64_t number, std::size_t most) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t newer = lines_so_far_ - std::min(number, lines_so_far_);
  const std::size_t count = std::min({most, lines_.size(), static_cast<std::size_t>(newer)});
  return {lines_.end() - static_cast<std::ptrdiff_t>(count), lines_.end()};
}

void RecentLog::sink_it_(const spdlog::details::log_msg& message) {
  LoggedLine line;
  line.number = ++lines_so_far_;
  line.level = message.level;
  line.t_wall_ns = std::chrono::nanoseconds(message.time.time_since_epoch()).count();
  if (!message.source.empty()) line.part = message.source.filename;  // as log_event() uses it
  line.text.assign(message.payload.data(), message.payload.size());
  lines_.push_back(std::move(line));
  if (lines_.size() > kKept) lines_.pop_front();
}

}  // namespace heel
