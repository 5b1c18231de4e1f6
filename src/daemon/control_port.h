// The control loop and the camera as the operator thread sees them.
#pragma once

#include <cstdint>
#include <mutex>
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

  OperatorRequest request(OperatorCommand command, TimeNs t_ns) override {
    // Two threads ask, and a mailbox of the control loop has one writer. Neither waits longer than a copy
    // takes.
    const std::lock_guard lock(mutex_);
    const OperatorRequest request{++number_, t_ns, command};
    control_.request(request);
    return request;
  }
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
  std::mutex mutex_;  // of the number, and of writing to the control loop's mailboxes
  std::uint64_t number_ = 0;
  ControlLoop& control_;
  const CaptureLoop& capture_;
  Telemetry& telemetry_;
};

}  // namespace heel
