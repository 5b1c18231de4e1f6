#include "operator/answers.h"

#include <fmt/format.h>

namespace heel {
namespace {

using json = nlohmann::ordered_json;

json answer(std::optional<std::int64_t> id, bool ok) {
  json out = {{"v", kProtocolVersion}};
  if (id) out["id"] = *id;
  out["ok"] = ok;
  return out;
}

/// Text that a client sent, and file names, may hold bytes that are no UTF-8: those are replaced.
std::string line_of(const json& object) {
  return object.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::string error_line(std::optional<std::int64_t> id, const std::string& error) {
  json out = answer(id, false);
  out["error"] = error;
  return line_of(out);
}

std::string token_line(std::optional<std::int64_t> id) {
  json out = answer(id, false);
  out["error"] = "not allowed without the token (expected a login before)";
  out["needs_token"] = true;
  return line_of(out);
}

std::string done_line(const Request& request) {
  return line_of(answer(request.id, true));
}

std::string help_line(const Request& request) {
  json out = answer(request.id, true);
  json& rows = out["requests"] = json::array();
  for (const RequestRow& row : request_table()) {
    json one = {{"do", row.name}};
    if (!row.field.empty()) one["field"] = row.field;
    one["effect"] = row.effect;
    rows.push_back(std::move(one));
  }
  return line_of(out);
}

std::string status_line(const Request& request, const StatusInput& input, const SettingsView& settings,
                        bool watched) {
  json out = answer(request.id, true);
  if (watched) out["event"] = "status";
  out.update(status_json(input, settings));
  return line_of(out);
}

std::string command_line(const Request& request, const CommandResult& result, const StatusInput& input) {
  json out = answer(request.id, result.error.empty());
  if (result.error.empty()) {
    out["outcome"] = to_string(result.outcome);
  } else {
    out["error"] = result.error;
  }
  out.update(state_json(input));
  return line_of(out);
}

std::string settings_request_text(SettingsJobKind kind) {
  switch (kind) {
    case SettingsJobKind::Set:
      return "set";
    case SettingsJobKind::Save:
      return "save";
    case SettingsJobKind::Reload:
      break;
  }
  return "reload";
}

std::string settings_answer_text(const SettingsAnswer& answered) {
  if (!answered.errors.empty()) return fmt::format("{}", fmt::join(answered.errors, "; "));
  std::string text;
  for (const ConfigChange& change : answered.changes)
    text += fmt::format("{}{}: {} -> {}", text.empty() ? "" : "; ", change.key, change.before, change.after);
  return text.empty() ? "nothing has changed" : text;
}

std::string settings_line(const Request& request, const SettingsAnswer& answered) {
  json out = answer(request.id, answered.errors.empty());
  if (answered.errors.empty()) {
    out["changes"] = changes_json(answered.changes);
  } else {
    out["error"] = fmt::format("{}", fmt::join(answered.errors, "; "));
  }
  return line_of(out);
}

}  // namespace heel
