// The supervisor decides in each tick whether the robot may move. It keeps the state of the table in
// control/state_table.h, and answers the operator's requests.
#pragma once

#include "control/state_table.h"
#include "core/config.h"
#include "heel/flow.h"

namespace heel {

/// The supervisor's decision of a tick.
struct Verdict {
  SupervisorState state = SupervisorState::Idle;
  TransitionCause cause = TransitionCause::Boot;  ///< of the last change of state …
  TimeNs t_transition_ns = 0;                     ///< … and its tick
  StopReason stop_reason = StopReason::NotStarted;
  StopStyle style = StopStyle::AtOnce;
  std::uint64_t request_number = 0;  ///< the newest request handled
  OperatorOutcome outcome = OperatorOutcome::None;
  StopReason refused_by = StopReason::None;
  bool needs_start = false;
  bool enable_motors = false;  ///< the session may enable the motors again
};

class Supervisor {
 public:
  explicit Supervisor(const SupervisorConfig& config);

  /// The command of a request that no tick has handled yet; None otherwise.
  OperatorCommand new_command(const OperatorRequest& request) const;

  /// One tick. `law_may_search`: the law can drive on without the target.
  Verdict update(const ControlInput& input, Conditions conditions, bool law_may_search,
                 const SupervisorConfig& config);

 private:
  void take_transitions(SupervisorFacts facts, TimeNs now_ns);
  void answer(OperatorCommand command, SupervisorState before, const SupervisorFacts& facts);
  StopReason stop_reason(Conditions conditions) const;

  bool at_once_;          // supervisor.start at the construction
  bool started_ = false;  // Idle has been left, or an operator has given a command
  bool halted_ = false;   // by an operator's stop: nothing resumes by itself until the next start
  StopReason fault_ = StopReason::None;  // that led to Stopped
  Verdict verdict_;
};

}  // namespace heel
