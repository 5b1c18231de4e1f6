// Why nothing answers at an address: the MQTT library only says that it could not connect.
#pragma once

#include <string>

namespace heel {

/// `address`: tcp://HOST:PORT or ssl://HOST:PORT. Empty: a TCP connection is possible.
std::string why_unreachable(const std::string& address);

}  // namespace heel
