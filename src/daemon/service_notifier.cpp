#include "daemon/service_notifier.h"

#include <systemd/sd-daemon.h>

namespace heel {

ServiceNotifier::ServiceNotifier() {
  std::uint64_t timeout_us = 0;
  // A third of the timeout: two feeds may be missed.
  if (sd_watchdog_enabled(0, &timeout_us) > 0) {
    watchdog_period_ns_ = static_cast<TimeNs>(timeout_us) * kNsPerUs / 3;
  }
}

void ServiceNotifier::ready() {
  sd_notify(0, "READY=1");
}

void ServiceNotifier::reloading(TimeNs now_ns) {
  sd_notifyf(0, "RELOADING=1\nMONOTONIC_USEC=%lld", static_cast<long long>(now_ns / kNsPerUs));
}

void ServiceNotifier::stopping() {
  sd_notify(0, "STOPPING=1");
}

void ServiceNotifier::status(const std::string& line) {
  if (line == status_) return;
  status_ = line;
  sd_notifyf(0, "STATUS=%s", line.c_str());
}

void ServiceNotifier::alive(TimeNs now_ns) {
  if (watchdog_period_ns_ == 0 || now_ns - t_fed_ns_ < watchdog_period_ns_) return;
  t_fed_ns_ = now_ns;
  sd_notify(0, "WATCHDOG=1");
}

}  // namespace heel
