#include "operator/operator_server.h"

#include <fmt/format.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <tuple>
#include <utility>

#include "heel/error.h"
#include "operator/answers.h"
#include "realtime/clock.h"

namespace heel {
namespace {

constexpr int kPendingWait_ms = 5;  // a command waits for a tick, one every 20 ms
constexpr int kWatchWait_ms = 50;   // somebody watches, or none can be accepted now
constexpr int kIdleWait_ms = 1000;

}  // namespace

OperatorServer::OperatorServer(LocalSocket socket, OperatorPort& port, const Settings& settings,
                               SettingsLoop& settings_loop)
    : socket_(std::move(socket)),
      port_(port),
      settings_(settings),
      settings_loop_(settings_loop),
      commands_(port),
      wake_fd_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (wake_fd_ < 0) throw Error(std::string("operator: no eventfd: ") + std::strerror(errno));
  settings_loop_.on_answer([this] { wake(); });
}

OperatorServer::~OperatorServer() {
  clients_.clear();
  close(wake_fd_);
}

void OperatorServer::run() {
  spdlog::info("operators are served at {}", socket_.path());
  while (!stop_.load(std::memory_order_acquire)) {
    wait();
    read_requests();  // before a new client takes the place of one that has asked
    accept_clients();
    take_tick();
    const TimeNs now_ns = monotonic_now_ns();
    settle_commands(now_ns);
    settle_settings();
    send_to_watchers(now_ns);
    remove_finished();
  }
  clients_.clear();
}

void OperatorServer::stop() {
  stop_.store(true, std::memory_order_release);
  wake();
}

void OperatorServer::wake() const {
  const std::uint64_t one = 1;
  // It fails only when the counter is full: then the thread is awake.
  [[maybe_unused]] const ssize_t written = write(wake_fd_, &one, sizeof one);
}

int OperatorServer::poll_timeout_ms() const {
  if (commands_.busy()) return kPendingWait_ms;
  const bool watched = std::any_of(clients_.begin(), clients_.end(),
                                   [](const auto& client) { return client->watch.has_value(); });
  return watched || socket_.pauses(monotonic_now_ns()) ? kWatchWait_ms : kIdleWait_ms;
}

/// Until something has come from a client or the settings thread, or it is time to look.
void OperatorServer::wait() {
  std::vector<pollfd> descriptors = {{socket_.pauses(monotonic_now_ns()) ? -1 : socket_.fd(), POLLIN, 0},
                                     {wake_fd_, POLLIN, 0}};
  for (const auto& client : clients_) {
    const int events = (client->input_ended() ? 0 : POLLIN) | (client->wants_to_write() ? POLLOUT : 0);
    descriptors.push_back({client->fd(), static_cast<short>(events), 0});
  }
  if (poll(descriptors.data(), descriptors.size(), poll_timeout_ms()) <= 0) return;
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t woken = ::read(wake_fd_, &count, sizeof count);
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    const short events = descriptors[i + 2].revents;
    if ((events & POLLOUT) != 0) clients_[i]->flush();
    if ((events & POLLIN) != 0) {
      clients_[i]->read();
    } else if ((events & (POLLHUP | POLLERR | POLLNVAL)) != 0) {
      clients_[i]->give_up();
    }
  }
}

int OperatorServer::invite(std::string who, MayWrite may_write) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw Error(std::string("operator: no pair of sockets: ") + std::strerror(errno));
  {
    const std::lock_guard lock(invited_mutex_);
    invited_.push_back(std::make_unique<Connection>(ends[0], ++clients_so_far_, monotonic_now_ns(),
                                                    std::move(who), std::move(may_write)));
  }
  wake();
  return ends[1];
}

std::size_t OperatorServer::local_clients() const {
  return static_cast<std::size_t>(
      std::count_if(clients_.begin(), clients_.end(), [](const auto& one) { return one->local(); }));
}

void OperatorServer::accept_clients() {
  std::vector<std::unique_ptr<Connection>> invited;
  {
    const std::lock_guard lock(invited_mutex_);
    invited.swap(invited_);
  }
  for (auto& client : invited) clients_.push_back(std::move(client));
  for (std::size_t i = 0; i < kMaxClients; ++i) {
    const TimeNs now_ns = monotonic_now_ns();
    const int fd = socket_.accept(now_ns);
    if (fd < 0) return;
    if (local_clients() >= kMaxClients) make_room();
    clients_.push_back(std::make_unique<Connection>(fd, ++clients_so_far_, now_ns));
  }
}

/// Clients that hang must not keep out the one that wants to stop the robot: the one that has asked for
/// nothing for longest goes, of those that neither watch nor wait for an answer. What any of them has sent
/// until now is served before.
void OperatorServer::make_room() {
  for (const auto& client : clients_) client->read_all();
  read_requests();
  remove_finished();
  if (local_clients() < kMaxClients) return;
  const auto rank = [](const Connection& client) {
    return std::tuple(!client.local(), client.watch.has_value(), client.open_requests > 0,
                      client.t_active_ns);
  };
  const auto idle = std::min_element(clients_.begin(), clients_.end(),
                                     [&](const auto& a, const auto& b) { return rank(*a) < rank(*b); });
  (*idle)->send_line(error_line({}, fmt::format("closed: more than {} clients", kMaxClients)));
  clients_.erase(idle);
}

/// Every line that has come, emergency stops first.
void OperatorServer::read_requests() {
  struct Line {
    Connection* client;
    ParsedRequest parsed;
  };
  std::vector<Line> lines;
  std::string text;
  for (const auto& client : clients_) {
    while (client->take_line(text)) lines.push_back({client.get(), parse_request(text)});
    if (client->take_partial_end())
      client->send_line(error_line({}, "the last line has no end (expected a newline after each request)"));
  }
  const auto is_estop = [](const Line& line) {
    return line.parsed.error.empty() && line.parsed.request.kind == RequestKind::EStop;
  };
  std::stable_partition(lines.begin(), lines.end(), is_estop);
  const TimeNs now_ns = monotonic_now_ns();
  for (Line& line : lines) {
    const bool too_many = !line.client->rate.allow(now_ns);
    if (line.client->closing() && !is_estop(line)) continue;
    if (line.parsed.error.empty() && (!too_many || is_estop(line))) {
      serve(*line.client, std::move(line.parsed.request), now_ns);
    } else if (!too_many) {
      line.client->send_line(error_line(line.parsed.request.id, line.parsed.error));
    }
    if (!too_many) continue;
    line.client->send_line(error_line(
        {},
        fmt::format("closed: too many requests (expected at most {} a second)", Connection::kRequestsPerS)));
    line.client->close_after_answers();
  }
}

void OperatorServer::serve(Connection& client, Request request, TimeNs now_ns) {
  client.t_active_ns = now_ns;
  if (client.may_write()) {
    port_.alive(now_ns);
  } else if (!needs_no_token(request.kind)) {
    client.send_line(token_line(request.id));
    return;
  }
  switch (request.kind) {
    case RequestKind::Help:
      client.send_line(help_line(request));
      return;
    case RequestKind::Alive:
      client.send_line(done_line(request));
      return;
    case RequestKind::Status:
      take_tick();
      client.send_line(status_line(request, status_input(now_ns), settings_.view(), false));
      return;
    case RequestKind::Watch:
      start_watch(client, request);
      return;
    case RequestKind::Set:
    case RequestKind::Save:
      start_settings_job(client, std::move(request));
      return;
    case RequestKind::Mark: {
      const std::string error = port_.mark(request.text);
      port_.answered(client.who(), "mark", error.empty() ? "done" : error);
      client.send_line(error.empty() ? done_line(request) : error_line(request.id, error));
      return;
    }
    case RequestKind::Start:
      if (client.peer_gone()) {
        spdlog::warn("operator ({}): start: not done: the client is gone", client.who());
        client.give_up();
        return;
      }
      [[fallthrough]];
    case RequestKind::Stop:
    case RequestKind::EStop:
    case RequestKind::Reset:
      const OperatorCommand command = command_of(request.kind);
      commands_.add(command, ask(client, std::move(request)), now_ns);
      return;
  }
}

void OperatorServer::start_watch(Connection& client, const Request& request) {
  const auto watchers = std::count_if(clients_.begin(), clients_.end(), [&](const auto& one) {
    return one->watch.has_value() && one->local() == client.local();
  });
  if (!client.watch && static_cast<std::size_t>(watchers) >= kMaxWatchers) {
    client.send_line(error_line(request.id, fmt::format("{} clients watch already", kMaxWatchers)));
    return;
  }
  client.watch = Watch{request.id, ns_from_seconds(request.period_s)};
}

void OperatorServer::start_settings_job(Connection& client, Request request) {
  SettingsJob job{request.kind == RequestKind::Set ? SettingsJobKind::Set : SettingsJobKind::Save};
  job.who = fmt::format("operator ({})", client.who());
  job.assignments = request.assignments;
  const auto id = request.id;
  job.ticket = ask(client, std::move(request));
  const std::uint64_t ticket = job.ticket;
  if (settings_loop_.post(std::move(job))) return;
  Request given_up;
  take_asker(ticket, given_up);
  client.send_line(
      error_line(id, fmt::format("{} changes of settings wait already", SettingsLoop::kMaxWaiting)));
}

void OperatorServer::take_tick() {
  TickRecord newest;
  if (!port_.take_tick(newest)) return;
  if (!any_tick_ || differs_to_a_watcher(tick_, newest)) {
    for (const auto& client : clients_)
      if (client->watch) client->watch->changed = true;
  }
  tick_ = newest;
  any_tick_ = true;
}

void OperatorServer::settle_commands(TimeNs now_ns) {
  if (!commands_.busy()) return;
  for (const CommandResult& result : commands_.settle(tick_, now_ns)) {
    Request request;
    Connection* client = take_asker(result.ticket, request);
    const StatusInput input = status_input(now_ns);
    const std::string who = client != nullptr ? client->who() : "gone";
    spdlog::info("operator ({}): {}: {}", who, to_string(result.command),
                 result.error.empty() ? to_string(tick_.state) : result.error);
    port_.answered(who, to_string(result.command),
                   result.error.empty() ? to_string(result.outcome) : result.error);
    if (client != nullptr) client->send_line(command_line(request, result, input));
  }
}

void OperatorServer::settle_settings() {
  SettingsAnswer answer;
  while (settings_loop_.take(answer)) {
    for (const auto& client : clients_)
      if (client->watch) client->watch->changed = true;
    Request request;
    Connection* client = take_asker(answer.ticket, request);
    port_.answered(client != nullptr ? client->who() : "gone", settings_request_text(answer.kind),
                   settings_answer_text(answer));
    if (client != nullptr) client->send_line(settings_line(request, answer));
  }
}

void OperatorServer::send_to_watchers(TimeNs now_ns) {
  for (const auto& client : clients_) {
    if (!client->watch) continue;
    Watch& watch = *client->watch;
    const TimeNs since_ns = now_ns - watch.t_sent_ns;
    const bool due = since_ns >= watch.period_ns || (watch.changed && since_ns >= kWatchSpacing_ns);
    if (!due) continue;
    watch.t_sent_ns = now_ns;
    watch.changed = false;
    Request request;
    request.id = watch.id;
    client->send_line(status_line(request, status_input(now_ns), settings_.view(), true));
  }
}

void OperatorServer::remove_finished() {
  std::erase_if(clients_, [](const auto& client) { return client->finished(); });
}

std::uint64_t OperatorServer::ask(Connection& client, Request request) {
  ++client.open_requests;
  asked_[++tickets_] = {client.number(), std::move(request)};
  return tickets_;
}

Connection* OperatorServer::take_asker(std::uint64_t ticket, Request& request) {
  const auto found = asked_.find(ticket);
  if (found == asked_.end()) return nullptr;
  request = std::move(found->second.request);
  const std::uint64_t number = found->second.connection;
  asked_.erase(found);
  for (const auto& client : clients_) {
    if (client->number() != number) continue;
    --client->open_requests;
    return client.get();
  }
  return nullptr;
}

StatusInput OperatorServer::status_input(TimeNs now_ns) const {
  return {tick_, any_tick_, port_.camera(), now_ns};
}

}  // namespace heel
