// The lines that the operator thread sends: docs/operator.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "operator/commands.h"
#include "operator/request.h"
#include "operator/settings_loop.h"
#include "operator/status.h"

namespace heel {

/// {"v":1,"id":7,"ok":false,"error":"one line"}
std::string error_line(std::optional<std::int64_t> id, const std::string& error);
/// The same for a request that a client may not make before it has said the token; with "needs_token":true.
std::string token_line(std::optional<std::int64_t> id);
/// {"v":1,"id":7,"ok":true}
std::string done_line(const Request& request);
/// The table of requests.
std::string help_line(const Request& request);
/// The whole status; a line of a watch has "event":"status".
std::string status_line(const Request& request, const StatusInput& input, const SettingsView& settings,
                        bool watched);
/// What became of start, stop, estop or reset, and the state after it.
std::string command_line(const Request& request, const CommandResult& result, const StatusInput& input);
/// The same for the recording: "set", and "gate.v_max_m_s: 0.7 -> 0.3" or why not.
std::string settings_request_text(SettingsJobKind kind);
std::string settings_answer_text(const SettingsAnswer& answer);
/// What set or save has changed.
std::string settings_line(const Request& request, const SettingsAnswer& answer);

}  // namespace heel
