// What systemd is told: sd_notify(3). Without systemd (no NOTIFY_SOCKET) every call does nothing.
#pragma once

#include <string>

#include "heel/time.h"

namespace heel {

class ServiceNotifier {
 public:
  ServiceNotifier();

  /// Handshake with the robot done and the first frame seen.
  void ready();
  /// Before a reload: with the time, without which systemd 252 waits for nothing; after it, ready().
  void reloading(TimeNs now_ns);
  void stopping();
  /// One line for `systemctl status`; sent when it changes.
  void status(const std::string& line);
  /// Call often: feeds the watchdog when it is due.
  void alive(TimeNs now_ns);

 private:
  TimeNs watchdog_period_ns_ = 0;  // 0: no watchdog
  TimeNs t_fed_ns_ = 0;
  std::string status_;
};

}  // namespace heel
