// Logging: spdlog's default logger, asynchronous, on standard error; under systemd in the journal, with
// fields (journal_sink.h). Hot threads do not log: they push Event records (heel/flow.h), which the telemetry
// thread formats.
#pragma once

#include <memory>
#include <string>

namespace spdlog {
class formatter;
}

namespace heel {

/// Starts logging at `level`: trace, debug, info, warn, error, critical or off. Throws heel::Error otherwise.
void start_logging(const std::string& level);

/// Changes the level while running; throws heel::Error as above and changes nothing then.
void set_log_level(const std::string& level);

/// Writes out what is waiting and ends the logging thread. Later messages are written directly.
void stop_logging();

/// True: standard error is connected to the journal (JOURNAL_STREAM names it; a shell started from a service
/// inherits the variable, but not the stream).
bool stderr_is_journal();

/// "HH:MM:SS.mmm level text", for a person at a terminal.
std::unique_ptr<spdlog::formatter> make_terminal_formatter();

}  // namespace heel
