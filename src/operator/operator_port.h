// What the operator thread and the page's thread need of the daemon. None of it waits.
#pragma once

#include <string>

#include "heel/flow.h"

namespace heel {

class OperatorPort {
 public:
  virtual ~OperatorPort() = default;
  /// Hands the newest request to the control loop, and returns it with its number; an emergency stop is never
  /// replaced by a later request. From any thread.
  virtual OperatorRequest request(OperatorCommand command, TimeNs t_ns) = 0;
  /// A sign that the operator is there.
  virtual void alive(TimeNs t_ns) = 0;
  /// True and the newest tick, when there is one not taken before.
  virtual bool take_tick(TickRecord& out) = 0;
  virtual CaptureCounters camera() = 0;
  /// For the recording: what an operator asked for, and what became of it.
  virtual void answered(const std::string& who, const std::string& request, const std::string& answer) = 0;
  /// A mark in the recording. Returns why there is none; empty: done.
  virtual std::string mark(const std::string& text) = 0;
};

}  // namespace heel
