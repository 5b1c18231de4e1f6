// heeld's local socket for the commands of operators (docs/operator.md): the option that names it, and a
// client of its protocol.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

namespace heel::cli {

using Json = nlohmann::ordered_json;

struct OperatorOptions {
  std::string socket = "/run/heel/control.sock";
  bool json = false;  ///< print heeld's answers as they are
};

/// Adds --socket and --json.
void add_operator_options(
    CLI::App& command, OperatorOptions& options,
    const std::string& json_help = "heeld's answer, one JSON object (docs/operator.md)");

/// A connection to heeld. Where heeld cannot be reached, does not answer in time or ends, each call prints
/// one line that names the likely cause, and throws CLI::RuntimeError(kExitUnreachable).
class OperatorClient {
 public:
  /// `command`: the name in messages, as "start".
  OperatorClient(const OperatorOptions& options, std::string command);
  ~OperatorClient();
  OperatorClient(const OperatorClient&) = delete;
  OperatorClient& operator=(const OperatorClient&) = delete;

  /// Sends a request, without waiting for its answer.
  void send(Json request);
  /// The next line; null when none has come in time.
  Json next(double timeout_s);
  /// Sends a request and returns its answer. An answer that is a refusal is printed, with --json as it is as
  /// well, and ends the command with CLI::RuntimeError(kExitNo).
  Json ask(const Json& request, double timeout_s);
  /// Prints why heeld cannot be reached any more, and throws.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  std::string socket_;
  std::string command_;
  bool json_ = false;
  int fd_ = -1;
  std::string waiting_;
};

/// A subcommand that asks for `name` and prints the state that it leads to.
void add_operator_command(CLI::App& app, const std::string& name, const std::string& description);

/// "FOLLOWING: Following the person."
std::string state_line(const Json& answer);
/// The answer as it is with --json, else `text`.
void print_answer(const OperatorOptions& options, const Json& answer, const std::string& text);
/// "key: old -> new", a line each.
std::string changes_text(const Json& changes);

}  // namespace heel::cli
