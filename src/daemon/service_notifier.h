// Messages to systemd by sd_notify(3). Without systemd (no NOTIFY_SOCKET) every call does nothing.
#pragma once

#include <string>

#include "heel/time.h"

namespace heel {

class ServiceNotifier {
 public:
  ServiceNotifier();

  /// The service is ready; also ends a reload.
  void ready();
  /// Before a reload; ready() follows after it. systemd waits for the end of a reload only if it got the
  /// time.
  void reloading(TimeNs now_ns);
  void stopping();
  /// One line for `systemctl status`; sent when it changes.
  void status(const std::string& line);
  /// To be called often: feeds the watchdog when that is due.
  void alive(TimeNs now_ns);

 private:
  TimeNs watchdog_period_ns_ = 0;  // 0: no watchdog
  TimeNs t_fed_ns_ = 0;
  std::string status_;
};

}  // namespace heel
