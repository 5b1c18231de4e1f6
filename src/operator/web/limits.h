// The bounds of what browsers may ask of the page's server; docs/page.md lists them.
#pragma once

#include <cstddef>

#include "heel/time.h"

namespace heel {

// Connections.
inline constexpr std::size_t kMaxPageConnections = 64;       ///< of all addresses
inline constexpr std::size_t kMaxConnectionsOfAddress = 32;  ///< beyond it an emergency stop alone is served
inline constexpr double kNewConnectionsOfAddress_1_s = 8.0;  ///< the same; averaged
inline constexpr double kConnectionBurstOfAddress = 48.0;    ///< so many at once
inline constexpr std::size_t kMaxViewers = 8;                ///< of the live data
inline constexpr std::size_t kMaxPageOperators = 8;          ///< connections to /operator
inline constexpr double kPageRequestsPerS = 100.0;           ///< of one connection

// Sizes.
inline constexpr std::size_t kMaxHeadBytes = 8 * 1024;
inline constexpr std::size_t kMaxBodyBytes = 16 * 1024;
inline constexpr std::size_t kMaxMessageBytes = 4096;        ///< from a browser
inline constexpr std::size_t kMaxWaitingBytes = 512 * 1024;  ///< to a browser that does not read
inline constexpr int kSendBufferBytes = 256 * 1024;          ///< of the kernel, for a WebSocket

// Times.
inline constexpr TimeNs kRequestTime_ns = 5 * kNsPerS;  ///< for a whole request, and idle between two
inline constexpr TimeNs kAnswerTime_ns = 10 * kNsPerS;  ///< for the browser to take an answer
inline constexpr TimeNs kSilence_ns = 20 * kNsPerS;     ///< a WebSocket that does not answer a ping is closed
inline constexpr TimeNs kStopAnswer_ns = 80 * kNsPerMs;  ///< longest wait for the word of the control loop

// The token.
inline constexpr std::size_t kMinTokenBytes = 16;
inline constexpr std::size_t kMaxTokenBytes = 512;
inline constexpr double kTokenTriesPerMinute = 5.0;      ///< of one address
inline constexpr double kAllTokenTriesPerMinute = 60.0;  ///< of all addresses

}  // namespace heel
