// The operator of a run in lock step: requests at given times.
#pragma once

#include <utility>
#include <vector>

#include "heel/flow.h"

namespace heel::sim {

/// What the simulated operator asks for, and when.
struct OperatorAction {
  double t_s = 0.0;
  OperatorCommand command = OperatorCommand::Start;
};

class SimulatedOperator {
 public:
  /// `actions` in the order of time.
  explicit SimulatedOperator(std::vector<OperatorAction> actions) : actions_(std::move(actions)) {}

  /// The newest request at the time of a tick. One a tick, as in the daemon: a second action of the same time
  /// comes in the next tick.
  OperatorRequest request_at(TimeNs t_ns) {
    if (request_.number < actions_.size()) {
      const OperatorAction& next = actions_[request_.number];
      if (ns_from_seconds(next.t_s) <= t_ns) request_ = {request_.number + 1, t_ns, next.command};
    }
    return request_;
  }

 private:
  std::vector<OperatorAction> actions_;
  OperatorRequest request_;
};

}  // namespace heel::sim
