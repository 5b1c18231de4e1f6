// Logging by spdlog's default logger: asynchronous, to standard error, or under systemd to the journal with
// fields (journal_sink.h). Real-time threads do not log: they push Event records (heel/flow.h), and the
// telemetry thread logs them.
#pragma once

#include <memory>
#include <string>

namespace spdlog {
class formatter;
namespace sinks {
class sink;
}
}  // namespace spdlog

namespace heel {

/// Starts logging at `level`: trace, debug, info, warn, error, critical or off. Throws heel::Error otherwise.
/// `also_to`, where given, gets every message too.
void start_logging(const std::string& level, std::shared_ptr<spdlog::sinks::sink> also_to = nullptr);

/// Changes the level while running. Throws heel::Error for an unknown level, which changes nothing.
void set_log_level(const std::string& level);

/// Writes the waiting messages and ends the logging thread. Later messages are written directly.
void stop_logging();

/// True: standard error is connected to the journal, as JOURNAL_STREAM says. (A shell started from a service
/// inherits the variable but not the stream.)
bool stderr_is_journal();

/// "HH:MM:SS.mmm level text", for a terminal.
std::unique_ptr<spdlog::formatter> make_terminal_formatter();

}  // namespace heel
