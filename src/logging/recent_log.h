// The newest lines of the log, for the page.
#pragma once

#include <spdlog/sinks/base_sink.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <vector>

#include "heel/time.h"

namespace heel {

struct LoggedLine {
  std::uint64_t number = 0;  ///< counts from 1
  TimeNs t_wall_ns = 0;      ///< since 1970
  spdlog::level::level_enum level = spdlog::level::info;
  std::string part;  ///< of heel, as "camera"; empty: not said
  std::string text;
};

/// A sink of the log. Older lines are forgotten.
class RecentLog final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  static constexpr std::size_t kKept = 500;

  /// The newest of those with a larger number, at most so many; the oldest first. From any thread.
  std::vector<LoggedLine> after(std::uint64_t number, std::size_t most);

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override;
  void flush_() override {}

 private:
  std::deque<LoggedLine> lines_;  // guarded by the base class's mutex_
  std::uint64_t lines_so_far_ = 0;
};

}  // namespace heel
