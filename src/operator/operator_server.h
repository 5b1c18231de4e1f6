// The loop of the operator thread: serves the local socket by the protocol of docs/operator.md. It is no
// real-time thread. Whatever the clients do, the control loop gets only the newest request, through a
// mailbox; no client waits for another one, and none is waited for.
//
//   OperatorServer server(LocalSocket("/run/heel/control.sock"), port, settings, settings_loop);
//   std::thread thread([&] { server.run(); });
//   …  server.stop(); thread.join();
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "operator/commands.h"
#include "operator/connection.h"
#include "operator/local_socket.h"
#include "operator/operator_port.h"
#include "operator/settings.h"
#include "operator/settings_loop.h"
#include "operator/status.h"

namespace heel {

class OperatorServer {
 public:
  static constexpr std::size_t kMaxClients = 16;  ///< processes of this computer
  static constexpr std::size_t kMaxWatchers = 8;  ///< of them; and as many of those that are invited
  static constexpr TimeNs kWatchSpacing_ns = 100 * kNsPerMs;  ///< least time between two lines to a watcher

  /// All but the socket is borrowed and must outlive run(), and `settings_loop` must have ended before this
  /// object does.
  OperatorServer(LocalSocket socket, OperatorPort& port, const Settings& settings,
                 SettingsLoop& settings_loop);
  ~OperatorServer();

  /// Until stop().
  void run();
  // From any thread:
  void stop();
  /// A client that is no process of this computer, as a browser behind the page: the descriptor of its end of
  /// a connection, which does not block and which the caller closes. Until `may_write` is true it may only
  /// read and stop the robot, and is no sign of the operator. Throws heel::Error without a free descriptor.
  /// The caller bounds how many there are.
  int invite(std::string who, MayWrite may_write);

 private:
  struct Asked {  // a request whose answer comes later
    std::uint64_t connection = 0;
    Request request;
  };

  void wake() const;
  int poll_timeout_ms() const;
  void wait();
  void accept_clients();
  std::size_t local_clients() const;
  void make_room();
  void read_requests();
  void serve(Connection& client, Request request, TimeNs now_ns);
  void start_watch(Connection& client, const Request& request);
  void start_settings_job(Connection& client, Request request);
  void take_tick();
  void settle_commands(TimeNs now_ns);
  void settle_settings();
  void send_to_watchers(TimeNs now_ns);
  void remove_finished();

  std::uint64_t ask(Connection& client, Request request);
  /// The asker of a ticket, which is then used up; null: it has gone. `request` gets what it asked.
  Connection* take_asker(std::uint64_t ticket, Request& request);
  StatusInput status_input(TimeNs now_ns) const;

  LocalSocket socket_;
  OperatorPort& port_;
  const Settings& settings_;
  SettingsLoop& settings_loop_;
  CommandQueue commands_;
  int wake_fd_ = -1;
  std::atomic<bool> stop_{false};

  std::mutex invited_mutex_;
  std::vector<std::unique_ptr<Connection>> invited_;  // guarded by invited_mutex_; not among the clients yet
  std::vector<std::unique_ptr<Connection>> clients_;
  std::atomic<std::uint64_t> clients_so_far_{0};
  std::map<std::uint64_t, Asked> asked_;  // by ticket
  std::uint64_t tickets_ = 0;
  TickRecord tick_;
  bool any_tick_ = false;
};

}  // namespace heel
