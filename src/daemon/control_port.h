// The control loop and the camera as the operator thread sees them.
#pragma once

#include <string>

#include "daemon/capture_loop.h"
#include "daemon/control_loop.h"
#include "operator/operator_port.h"
#include "realtime/clock.h"
#include "telemetry/telemetry.h"

namespace heel {

class ControlPort final : public OperatorPort {
 public:
  /// All are borrowed.
  ControlPort(ControlLoop& control, const CaptureLoop& capture, Telemetry& telemetry)
      : control_(control), capture_(capture), telemetry_(telemetry) {}

  void request(const OperatorRequest& request) override { control_.request(request); }
  void alive(TimeNs t_ns) override { control_.operator_alive(t_ns); }
  bool take_tick(TickRecord& out) override { return control_.take_operator_status(out); }
  CaptureCounters camera() override { return capture_.counters(); }
  void answered(const std::string& who, const std::string& request, const std::string& answer) override {
    telemetry_.operator_line({monotonic_now_ns(), who, request, answer});
  }
  std::string mark(const std::string& text) override {
    return telemetry_.mark(text) ? ""
                                 : "nothing is recorded (telemetry.directory names no folder, or "
                                   "telemetry.keep_mb was reached)";
  }

 private:
  ControlLoop& control_;
  const CaptureLoop& capture_;
  Telemetry& telemetry_;
};

}  // namespace heel
