// Messages to systemd by the protocol of sd_notify(3). Without systemd (no NOTIFY_SOCKET) every call does
// nothing.
//
// sd_notify() blocks when systemd does not read. These calls do not: the main thread must stop the robot also
// then.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <deque>
#include <string>

#include "heel/time.h"

namespace heel {

class ServiceNotifier {
 public:
  ServiceNotifier();
  ~ServiceNotifier();
  ServiceNotifier(const ServiceNotifier&) = delete;
  ServiceNotifier& operator=(const ServiceNotifier&) = delete;

  /// The service is ready; also ends a reload. This message and the next two are kept when systemd does not
  /// take them, and every later call sends them again, in order.
  void ready();
  /// Before a reload; ready() follows after it. systemd waits for the end of a reload only if it got the
  /// time.
  void reloading(TimeNs now_ns);
  void stopping();
  /// One line for `systemctl status`; sent when it changes. Call it often: a line that systemd did not take
  /// is sent by the next call.
  void status(const std::string& line);
  /// To be called often: feeds the watchdog when that is due.
  void alive(TimeNs now_ns);
  /// Sends the kept messages again. True: none is left.
  bool send_kept();

 private:
  void keep(std::string message);
  bool send(const std::string& message) const;

  int fd_ = -1;            // a datagram socket that does not block; −1: there is no systemd
  sockaddr_un address_{};  // of systemd's socket
  socklen_t address_size_ = 0;
  std::deque<std::string> kept_;   // not yet taken by systemd, oldest first
  TimeNs watchdog_period_ns_ = 0;  // 0: no watchdog
  TimeNs t_fed_ns_ = 0;
  std::string status_;
};

}  // namespace heel
