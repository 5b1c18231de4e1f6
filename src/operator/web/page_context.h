// What the connections of the page's server share. One thread uses it.
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "operator/operator_port.h"
#include "operator/operator_server.h"
#include "operator/web/address_limits.h"
#include "operator/web/http_answers.h"
#include "operator/web/live_hub.h"
#include "operator/web/token.h"

namespace heel {

class Presence;

struct PageContext {
  OperatorPort& port;
  OperatorServer* operators;  // null: none
  const Settings& settings;
  const Telemetry& telemetry;
  const Token token;
  LiveHub hub;
  const HttpAnswers answers;
  AddressLimits limits{};
  std::size_t page_operators = 0;
  std::vector<Presence*> present{};  // every connection
  // In the log: a client must not fill it.
  Allowance warnings{1.0, 10.0}, logged_stops{1.0, 10.0};
  // Destroyed first: what its handlers hold uses the rest.
  boost::asio::io_context io{1};

  void warn(const std::string& text);
};

/// One connection, from its acceptance to its end, whatever it becomes.
class Presence {
 public:
  /// `close` ends the connection.
  Presence(PageContext& context, std::string address);
  ~Presence();
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;

  const std::string& address() const { return address_; }
  /// Its address has too many connections: only an emergency stop is served.
  bool limited() const { return limited_; }
  void active();

  std::function<void()> close;  ///< ends the connection; empty: it may not be closed to make room
  bool closing = false;
  TimeNs t_active_ns = 0;

 private:
  PageContext& context_;
  const std::string address_;
  bool limited_ = false;
};

/// What is wrong with the token that somebody at `address` says; empty: it is the right one. Logged.
std::string try_token(PageContext& context, const std::string& address, const std::string& token);

/// Before another connection is accepted: closes the one that has asked for nothing for longest, when there
/// are too many. False: all that there are must stay.
bool make_room(PageContext& context);

}  // namespace heel
