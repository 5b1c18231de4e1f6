// What a recording holds beside the flow structs, as JSON and back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "heel/time.h"

namespace heel {

/// A line of the log, as foxglove.Log.
struct LogLine {
  TimeNs t_ns = 0;  ///< of the recording's clock
  std::string text;
};

/// Every key of a configuration with its value, as TOML.
struct ConfigurationText {
  TimeNs t_ns = 0;
  std::uint64_t number = 0;  ///< TickRecord::configuration
  std::string text;
};

/// What an operator asked for, and what became of it.
struct OperatorLine {
  TimeNs t_ns = 0;
  std::string who;
  std::string request;
  std::string answer;
};

/// About the recording itself.
struct RecordingNote {
  TimeNs t_ns = 0;
  std::string kind;  ///< "begin", "end", "mark", "lost"
  std::string text;
  std::uint64_t lost = 0;  ///< records that the recording does not have, until now
};

/// `t_log_ns`: t_ns on the clock of the file's messages, which viewers show.
std::string log_json(const LogLine& line, TimeNs t_log_ns);
std::string configuration_json(const ConfigurationText& configuration);
std::string operator_json(const OperatorLine& line);
std::string note_json(const RecordingNote& note);

// Throw heel::Error for a text that is none of these.
LogLine log_from_json(std::string_view json);
ConfigurationText configuration_from_json(std::string_view json);
OperatorLine operator_from_json(std::string_view json);
RecordingNote note_from_json(std::string_view json);

}  // namespace heel
