// Log messages in the journal's own protocol (sd_journal_sendv(3)), with fields that journalctl can select
// by:
//   journalctl -u heeld HEEL_PART=camera        journalctl HEEL_EVENT="camera lost"
#pragma once

#include <spdlog/common.h>
#include <spdlog/details/log_msg.h>

#include <string>
#include <vector>

namespace heel {

/// What a message is about. Both must be static strings, because another thread writes the message later.
struct LogTopic {
  const char* part;   ///< "camera", "robot", "supervisor", …
  const char* event;  ///< what happened: to_string() of an enumeration
};

/// As spdlog::log, with the fields HEEL_PART and HEEL_EVENT in the journal.
void log_event(const LogTopic& topic, spdlog::level::level_enum level, const std::string& text);

/// "NAME=value" for each field of a message: MESSAGE, PRIORITY, SYSLOG_IDENTIFIER, and those of log_event.
std::vector<std::string> journal_fields(const spdlog::details::log_msg& message);

spdlog::sink_ptr make_journal_sink();

}  // namespace heel
