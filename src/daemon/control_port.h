// The control loop and the camera as the operator thread sees them.
#pragma once

#include "daemon/capture_loop.h"
#include "daemon/control_loop.h"
#include "operator/operator_port.h"

namespace heel {

class ControlPort final : public OperatorPort {
 public:
  /// Both are borrowed.
  ControlPort(ControlLoop& control, const CaptureLoop& capture) : control_(control), capture_(capture) {}

  void request(const OperatorRequest& request) override { control_.request(request); }
  void alive(TimeNs t_ns) override { control_.operator_alive(t_ns); }
  bool take_tick(TickRecord& out) override { return control_.take_operator_status(out); }
  CaptureCounters camera() override { return capture_.counters(); }

 private:
  ControlLoop& control_;
  const CaptureLoop& capture_;
};

}  // namespace heel
