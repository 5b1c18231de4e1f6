// The server of the page: HTTP and WebSockets for browsers, by Boost.Beast, in one thread of ordinary
// priority. It serves the page's files, live data at /live, the operators' protocol at /operator, an
// emergency stop at /estop, and what monitoring reads at /metrics; docs/page.md. Whatever clients do, the
// control loop gets only the newest request of an operator, and nothing waits for a client.
//
//   ViewServer server(config.view, parts);      // listens; throws heel::Error
//   std::thread thread([&] { server.run(); });
//   …  server.stop(); thread.join();
#pragma once

#include <cstdint>
#include <memory>

#include "core/config.h"
#include "logging/recent_log.h"
#include "operator/operator_port.h"
#include "operator/operator_server.h"
#include "operator/settings.h"
#include "operator/web/live_feed.h"
#include "operator/web/page_files.h"
#include "operator/web/view_facts.h"
#include "telemetry/telemetry.h"

namespace heel {

/// What the server shows and serves. All is borrowed.
struct ViewParts {
  const Settings& settings;
  const Telemetry& telemetry;
  OperatorPort& port;
  OperatorServer* operators;  ///< null: no socket is configured, and none of its requests are served
  LiveFeed& feed;
  RecentLog& log;
  const ViewFacts& facts;
};

class ViewServer {
 public:
  /// Reads the token and listens at config.address. Throws heel::Error with one line when it cannot.
  ViewServer(const ViewConfig& config, const ViewParts& parts, PageFiles files = PageFiles::load());
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  /// Until stop().
  void run();
  /// From any thread.
  void stop();
  /// That it listens at.
  std::uint16_t port() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace heel
