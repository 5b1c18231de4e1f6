// The commands of operators on their way through the control loop: one after another, each with its answer,
// an emergency stop before all others.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "heel/flow.h"
#include "operator/operator_port.h"
#include "operator/request.h"

namespace heel {

/// None for a request that is no command.
OperatorCommand command_of(RequestKind kind);

/// What became of a command.
struct CommandResult {
  std::uint64_t ticket = 0;  ///< the asker's
  OperatorCommand command = OperatorCommand::None;
  OperatorOutcome outcome = OperatorOutcome::None;  ///< None: not done; `error` says why
  std::string error;
};

class CommandQueue {
 public:
  static constexpr std::size_t kMaxWaiting = 64;
  static constexpr TimeNs kPatience_ns = 500 * kNsPerMs;  ///< for the control loop to handle a command

  explicit CommandQueue(OperatorPort& port) : port_(port) {}

  /// An emergency stop goes to the control loop now, and what waits before it is given up. Any other command
  /// goes when those before it are done, and is given up when it has waited longer than kPatience_ns.
  void add(OperatorCommand command, std::uint64_t ticket, TimeNs now_ns);
  /// What is done by the newest tick, or given up; then the next command goes.
  std::vector<CommandResult> settle(const TickRecord& tick, TimeNs now_ns);
  /// A command waits for its answer.
  bool busy() const {
    return current_.has_value() || !emergency_stops_.empty() || !waiting_.empty() || !results_.empty();
  }

 private:
  struct Posted {
    OperatorRequest request;
    std::uint64_t ticket = 0;
  };

  void give_up(const Posted& posted, std::string error);
  void settle_emergency_stops(const TickRecord& tick, TimeNs now_ns);
  void settle_current(const TickRecord& tick, TimeNs now_ns);
  void post_next(TimeNs now_ns);

  OperatorPort& port_;
  std::optional<Posted> current_;
  std::vector<Posted> emergency_stops_;
  std::deque<Posted> waiting_;  // not posted yet
  std::vector<CommandResult> results_;
};

/// "refused: stop button pressed": why the newest request was not done.
std::string refusal_text(const TickRecord& tick);

}  // namespace heel
