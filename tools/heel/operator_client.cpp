#include "operator_client.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <iostream>

#include "commands.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

constexpr double kConnectTimeout_s = 2.0, kCommandTimeout_s = 2.0;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string why_no_connection(int error) {
  switch (error) {
    case ENOENT:
      return "no such socket (is heeld running? systemctl status heeld; another socket: --socket)";
    case ECONNREFUSED:
      return "nobody serves it (heeld is not running; systemctl status heeld)";
    case EACCES:
      return "permission denied (are you in the group heel? sudo usermod -aG heel $USER, then log in again)";
    case EAGAIN:
      return "heeld does not accept the connection (is it overloaded? systemctl status heeld)";
    default:
      return std::strerror(error);
  }
}

}  // namespace

void add_operator_options(CLI::App& command, OperatorOptions& options, const std::string& json_help) {
  command.add_flag("--json", options.json, json_help);
  command.add_option("--socket", options.socket, "heeld's local socket (operator.socket)")
      ->envname("HEEL_SOCKET")
      ->type_name("SOCKET")
      ->capture_default_str();
}

OperatorClient::OperatorClient(const OperatorOptions& options, std::string command)
    : socket_(options.socket), command_(std::move(command)), json_(options.json) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket_.size() >= sizeof address.sun_path)
    throw Error(fmt::format("{}: a name of {} bytes (expected at most {})", socket_, socket_.size(),
                            sizeof address.sun_path - 1));
  socket_.copy(address.sun_path, socket_.size());
  fd_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  timeval timeout{static_cast<time_t>(kConnectTimeout_s), 0};
  const bool connected = fd_ >= 0 &&
                         setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof timeout) == 0 &&
                         connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (connected) return;
  const int error = errno;
  if (fd_ >= 0) close(fd_);
  fail(fmt::format("{}: {}", socket_, why_no_connection(error)));
}

OperatorClient::~OperatorClient() {
  close(fd_);
}

void OperatorClient::fail(const std::string& what) const {
  std::cout << std::flush;
  std::cerr << "heel " << command_ << ": " << what << '\n';
  throw CLI::RuntimeError(kExitUnreachable);
}

void OperatorClient::send(Json request) {
  request["v"] = 1;
  const std::string line = request.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  std::string_view left = line;
  while (!left.empty()) {
    const ssize_t count = ::send(fd_, left.data(), left.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(socket_ + ": the connection ended (has heeld been stopped? systemctl status heeld)");
    left.remove_prefix(static_cast<std::size_t>(count));
  }
}

Json OperatorClient::next(double timeout_s) {
  const double end_s = now_s() + timeout_s;
  for (;;) {
    if (const std::size_t newline = waiting_.find('\n'); newline != std::string::npos) {
      Json line =
          Json::parse(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(newline), nullptr,
                      /*allow_exceptions=*/false);
      waiting_.erase(0, newline + 1);
      if (!line.is_object()) fail(socket_ + ": not the protocol of heeld (expected one JSON object a line)");
      return line;
    }
    pollfd readable{fd_, POLLIN, 0};
    const int wait_ms = static_cast<int>(std::max(0.0, 1000.0 * (end_s - now_s())));
    if (poll(&readable, 1, wait_ms) <= 0) {
      if (now_s() >= end_s) return nullptr;
      continue;
    }
    std::array<char, 4096> bytes;
    const ssize_t count = recv(fd_, bytes.data(), bytes.size(), 0);
    if (count <= 0) fail(socket_ + ": the connection ended (has heeld been stopped? systemctl status heeld)");
    waiting_.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

Json OperatorClient::ask(const Json& request, double timeout_s) {
  send(request);
  Json answer = next(timeout_s);
  if (answer.is_null()) fail(fmt::format("{}: heeld did not answer within {} s", socket_, timeout_s));
  if (answer.value("ok", false)) return answer;
  if (json_) std::cout << answer.dump() << std::endl;
  std::cerr << "heel " << command_ << ": " << answer.value("error", std::string("refused")) << '\n';
  if (answer.contains("state")) std::cerr << state_line(answer) << '\n';
  throw CLI::RuntimeError(kExitNo);
}

void add_operator_command(CLI::App& app, const std::string& name, const std::string& description) {
  auto options = std::make_shared<OperatorOptions>();
  CLI::App* command = app.add_subcommand(name, description);
  add_operator_options(*command, *options);
  command->callback([options, name] {
    OperatorClient client(*options, name);
    const Json answer = client.ask({{"do", name}}, kCommandTimeout_s);
    print_answer(*options, answer, state_line(answer) + "\n");
  });
}

std::string state_line(const Json& answer) {
  std::string state = answer.value("state", std::string("?"));
  std::transform(state.begin(), state.end(), state.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return state + ": " + answer.value("sentence", std::string());
}

void print_answer(const OperatorOptions& options, const Json& answer, const std::string& text) {
  std::cout << (options.json ? answer.dump() + "\n" : text);
}

std::string changes_text(const Json& changes) {
  std::string text;
  for (const Json& change : changes)
    text += fmt::format("{}: {} -> {}\n", change.value("key", std::string()),
                        change.value("before", std::string()), change.value("after", std::string()));
  return text;
}

}  // namespace heel::cli
