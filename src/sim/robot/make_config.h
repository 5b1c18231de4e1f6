// The CONFIGpac a robot with these settings answers with.
#pragma once

#include "arcos/config_packet.h"
#include "sim/robot/settings.h"

namespace heel::sim {

/// Rates in the order of HOSTBAUD's argument and of CONFIGpac's HostBaud.
inline constexpr int kBauds[] = {9600, 19200, 38400, 57600, 115200};

arcos::ConfigPacket make_config(const P3AtSettings& settings);

}  // namespace heel::sim
