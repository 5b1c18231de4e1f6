// Log messages in the journal's own protocol (sd_journal_sendv(3)), so that they can be asked for by field:
//   journalctl -u heeld HEEL_PART=camera        journalctl HEEL_EVENT="camera lost"
#pragma once

#include <spdlog/common.h>
#include <spdlog/details/log_msg.h>

#include <string>
#include <vector>

namespace heel {

/// What a message is about. Both are static strings: messages are written by another thread, later.
struct LogTopic {
  const char* part;   ///< "camera", "robot", "supervisor", …
  const char* event;  ///< what happened, in one of few words: to_string() of an enumeration
};

/// As spdlog::log, with the journal's fields HEEL_PART and HEEL_EVENT. Elsewhere the text says it all.
void log_event(const LogTopic& topic, spdlog::level::level_enum level, const std::string& text);

/// "NAME=value" of each field of a message: MESSAGE, PRIORITY, SYSLOG_IDENTIFIER and what log_event was
/// given.
std::vector<std::string> journal_fields(const spdlog::details::log_msg& message);

spdlog::sink_ptr make_journal_sink();

}  // namespace heel
