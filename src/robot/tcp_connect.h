// A TCP connection within a time limit.
#pragma once

#include <cstdint>
#include <string>

#include "heel/time.h"

namespace heel {

/// A connected, non-blocking socket, or −1 with the reason in `why`. Looking the name up may take longer.
int tcp_connect(const std::string& host, std::uint16_t port, TimeNs timeout_ns, std::string& why);

}  // namespace heel
