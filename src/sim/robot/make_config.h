// The CONFIGpac of a robot with given settings.
#pragma once

#include "arcos/config_packet.h"
#include "sim/robot/settings.h"

namespace heel::sim {

/// Baud rates; the index is the argument of HOSTBAUD and CONFIGpac's HostBaud.
inline constexpr int kBauds[] = {9600, 19200, 38400, 57600, 115200};

arcos::ConfigPacket make_config(const P3AtSettings& settings);

}  // namespace heel::sim
