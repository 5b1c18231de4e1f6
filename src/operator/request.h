// A request of an operator: one line of JSON, docs/operator.md.
//   {"v":1,"id":7,"do":"start"}   {"do":"set","values":{"gate.v_max_m_s":0.3}} {"do":"watch","period_s":0.5}
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_set.h"

namespace heel {

inline constexpr int kProtocolVersion = 1;
/// The longest line, without its end.
inline constexpr std::size_t kMaxRequestBytes = 4096;
inline constexpr std::size_t kMaxMarkBytes = 200;
inline constexpr double kWatchPeriodMin_s = 0.1, kWatchPeriodMax_s = 60.0;

enum class RequestKind : std::uint8_t {
  Help,
  Status,
  Start,
  Stop,
  EStop,
  Reset,
  Set,
  Save,
  Watch,
  Mark,
  Alive
};

struct Request {
  std::optional<std::int64_t> id;  ///< the client's number, which the answer repeats
  RequestKind kind = RequestKind::Help;
  std::vector<ConfigAssignment> assignments;  ///< of Set, in the order of the line
  std::string text;                           ///< of Mark
  double period_s = 1.0;                      ///< of Watch: the longest time between two lines
};

/// Requests that change nothing, and the emergency stop: no token is needed for them.
bool needs_no_token(RequestKind kind);

/// A row of the table of requests, which the parser, the answer to `help` and the manual share.
struct RequestRow {
  RequestKind kind;
  std::string_view name;   ///< the value of "do"
  std::string_view field;  ///< the only field beside v, id and do; empty: none
  std::string_view effect;
};
std::span<const RequestRow> request_table();

struct ParsedRequest {
  Request request;
  std::string error;  ///< one line; empty: `request` is good. With an error `request` has the id alone.
};

/// Any bytes; never throws for what they are.
ParsedRequest parse_request(std::string_view line);

}  // namespace heel
