// A TCP connection within a time limit.
#pragma once

#include <cstdint>
#include <string>

#include "heel/time.h"

namespace heel {

/// Returns a connected, non-blocking socket, or −1 with the reason in `why`. The timeout does not limit the
/// look-up of the host name.
int tcp_connect(const std::string& host, std::uint16_t port, TimeNs timeout_ns, std::string& why);

}  // namespace heel
