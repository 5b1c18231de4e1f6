#include "logging/logging.h"

#include <fmt/format.h>
#include <spdlog/async.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "heel/error.h"
#include "logging/journal_sink.h"
#include "realtime/schedule.h"

namespace heel {

namespace {

constexpr std::size_t kQueuedMessages = 4096;

spdlog::level::level_enum parse_level(const std::string& level) {
  for (const char* known : {"trace", "debug", "info", "warn", "error", "critical", "off"}) {
    if (level == known) return spdlog::level::from_str(level);
  }
  throw Error(fmt::format(
      "log level '{}': unknown (expected trace, debug, info, warn, error, critical or off)", level));
}

spdlog::sink_ptr make_sink() {
  if (stderr_is_journal()) return make_journal_sink();
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  sink->set_formatter(make_terminal_formatter());
  return sink;
}

}  // namespace

bool stderr_is_journal() {
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat file {};
  if (stream == nullptr || fstat(STDERR_FILENO, &file) != 0) return false;
  return stream == fmt::format("{}:{}", file.st_dev, file.st_ino);
}

std::unique_ptr<spdlog::formatter> make_terminal_formatter() {
  return std::make_unique<spdlog::pattern_formatter>("%H:%M:%S.%e %^%l%$ %v");
}

void start_logging(const std::string& level, std::shared_ptr<spdlog::sinks::sink> also_to) {
  const spdlog::level::level_enum parsed = parse_level(level);
  std::vector<spdlog::sink_ptr> sinks = {make_sink()};
  if (also_to) sinks.push_back(std::move(also_to));
  spdlog::init_thread_pool(kQueuedMessages, 1, [] { name_thread(ThreadRole::Log); });
  // When the reader of standard error is too slow, the oldest messages are dropped and no thread waits.
  auto logger =
      std::make_shared<spdlog::async_logger>("heel", sinks.begin(), sinks.end(), spdlog::thread_pool(),
                                             spdlog::async_overflow_policy::overrun_oldest);
  logger->set_level(parsed);
  logger->flush_on(spdlog::level::info);
  spdlog::set_default_logger(std::move(logger));
}

void set_log_level(const std::string& level) {
  spdlog::set_level(parse_level(level));
}

void stop_logging() {
  const auto level = spdlog::get_level();
  // Kept until the logging thread has been joined, so that this thread destroys the logger.
  const auto last_logger = spdlog::default_logger();
  spdlog::shutdown();
  // shutdown() leaves no default logger; a later message, such as a destructor's, needs one.
  auto logger = std::make_shared<spdlog::logger>("heel", make_sink());
  logger->set_level(level);
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace heel
