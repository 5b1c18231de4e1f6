#include "operator/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace heel {
namespace {

using json = nlohmann::ordered_json;

constexpr RequestRow kTable[] = {
    {RequestKind::Status, "status", "", "answers with the state of robot, camera, target and limits"},
    {RequestKind::Start, "start", "", "lets the robot move; refused while something must keep it at rest"},
    {RequestKind::Stop, "stop", "", "brings the robot to rest; it then needs a start"},
    {RequestKind::EStop, "estop", "", "stops the robot at once, from any state; it then needs a reset"},
    {RequestKind::Reset, "reset", "", "ends an emergency stop, or motors off after the STOP button"},
    {RequestKind::Set, "set", "values",
     "gives keys of the configuration new values until the next save, reload or restart; all of them or "
     "none"},
    {RequestKind::Save, "save", "", "writes the values that were set into the configuration file"},
    {RequestKind::Watch, "watch", "period_s",
     "sends the status at each change, and at least once in a period, until the connection ends"},
    {RequestKind::Mark, "mark", "text", "puts a mark with this text into the recording"},
    {RequestKind::Alive, "alive", "", "says that the operator is there (supervisor.operator_timeout_s)"},
    {RequestKind::Help, "help", "", "answers with this list"},
};

/// A text of the client inside an error: not longer than it helps.
std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 60;
  return fmt::format("'{}{}'", text.substr(0, kLongest), text.size() > kLongest ? "…" : "");
}

std::string list_of_names() {
  std::string names;
  for (const RequestRow& row : kTable) names += (names.empty() ? "" : ", ") + std::string(row.name);
  return names;
}

/// Reads one object into a request; the first error stays.
class Reader {
 public:
  explicit Reader(ParsedRequest& out) : out_(out) {}

  void read(const json& object) {
    read_id(object);
    const RequestRow* row = read_name(object);
    if (row == nullptr) return;
    out_.request.kind = row->kind;
    for (const auto& [field, value] : object.items()) {
      if (field == "v" || field == "id" || field == "do" || field == row->field) continue;
      fail(fmt::format("{}: a field that '{}' does not have (expected v, id, do{}{})", in_quotes(field),
                       row->name, row->field.empty() ? "" : ", ", row->field));
      return;
    }
    if (row->kind == RequestKind::Set) read_values(object);
    if (row->kind == RequestKind::Watch) read_period(object);
    if (row->kind == RequestKind::Mark) read_text(object);
  }

  void fail(std::string error) {
    if (out_.error.empty()) out_.error = std::move(error);
  }

 private:
  void read_id(const json& object) {
    if (const auto v = object.find("v"); v != object.end() && *v != kProtocolVersion)
      fail(fmt::format("v: another version of the protocol (expected {})", kProtocolVersion));
    const auto id = object.find("id");
    if (id == object.end()) return;
    constexpr std::int64_t kLargest = std::int64_t{1} << 53;  // the whole numbers of JavaScript
    if (!id->is_number_integer() || *id < 0 || *id > kLargest) {
      fail("id: expected a whole number from 0 to 2^53");
    } else {
      out_.request.id = id->get<std::int64_t>();
    }
  }

  const RequestRow* read_name(const json& object) {
    const auto name = object.find("do");
    if (name == object.end() || !name->is_string()) {
      fail("do: missing (expected one of " + list_of_names() + ")");
      return nullptr;
    }
    const std::string& text = name->get_ref<const std::string&>();
    const auto* row = std::find_if(std::begin(kTable), std::end(kTable),
                                   [&](const RequestRow& one) { return one.name == text; });
    if (row == std::end(kTable)) {
      fail(fmt::format("do: {} (expected one of {})", in_quotes(text), list_of_names()));
      return nullptr;
    }
    return row;
  }

  void read_values(const json& object) {
    const auto values = object.find("values");
    if (values == object.end() || !values->is_object() || values->empty()) {
      fail("values: expected an object of keys and their values, as {\"gate.v_max_m_s\":0.3}");
      return;
    }
    for (const auto& [key, value] : values->items()) {
      ConfigAssignment assignment{key, false};
      if (value.is_boolean()) {
        assignment.value = value.get<bool>();
      } else if (value.is_number_float() ||
                 (value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX)) {
        assignment.value = value.get<double>();
      } else if (value.is_number_integer()) {
        assignment.value = value.get<std::int64_t>();
      } else if (value.is_string()) {
        assignment.value = value.get<std::string>();
      } else {
        fail(fmt::format("values: {}: expected a number, a text, true or false", in_quotes(key)));
        return;
      }
      out_.request.assignments.push_back(std::move(assignment));
    }
  }

  void read_text(const json& object) {
    const auto text = object.find("text");
    if (text == object.end()) return;
    if (text->is_string() && text->get_ref<const std::string&>().size() <= kMaxMarkBytes) {
      out_.request.text = text->get<std::string>();
    } else {
      fail(fmt::format("text: expected a text of at most {} bytes", kMaxMarkBytes));
    }
  }

  void read_period(const json& object) {
    const auto period = object.find("period_s");
    if (period == object.end()) return;
    const double value_s = period->is_number() ? period->get<double>() : 0.0;
    if (value_s >= kWatchPeriodMin_s && value_s <= kWatchPeriodMax_s) {
      out_.request.period_s = value_s;
    } else {
      fail(fmt::format("period_s: expected a number {}…{} s", kWatchPeriodMin_s, kWatchPeriodMax_s));
    }
  }

  ParsedRequest& out_;
};

}  // namespace

std::span<const RequestRow> request_table() {
  return kTable;
}

bool needs_no_token(RequestKind kind) {
  return kind == RequestKind::Help || kind == RequestKind::Status || kind == RequestKind::Watch ||
         kind == RequestKind::EStop;
}

ParsedRequest parse_request(std::string_view line) {
  ParsedRequest parsed;
  Reader reader(parsed);
  if (line.size() > kMaxRequestBytes) {
    reader.fail(
        fmt::format("a line of more than {} bytes (expected one JSON object a line)", kMaxRequestBytes));
    return parsed;
  }
  try {
    const json object = json::parse(line);
    if (object.is_object()) {
      reader.read(object);
    } else {
      reader.fail("no JSON object (expected one a line, as {\"do\":\"status\"})");
    }
  } catch (const json::parse_error& error) {
    reader.fail(
        fmt::format("no JSON at byte {} (expected one object a line, as {{\"do\":\"status\"}})", error.byte));
  } catch (const json::exception&) {  // a number out of range
    reader.fail("no JSON that can be read (expected one object a line, as {\"do\":\"status\"})");
  }
  if (!parsed.error.empty()) {
    Request with_id;
    with_id.id = parsed.request.id;
    parsed.request = std::move(with_id);
  }
  return parsed;
}

}  // namespace heel
