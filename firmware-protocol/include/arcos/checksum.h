/// \file
/// The ARCOS checksum over a packet's body (id and payload, without header, count and checksum).
///
/// - Errors: none. It is weak: swapping two pairs, or errors in two pairs that cancel in the sum, go
///   unnoticed.
/// - Source: MobileRobots Inc., "Pioneer 3 Operations Manual", 2006, chapter on ARCOS.
#pragma once

#include <cstdint>
#include <span>

namespace arcos {

/// Sum of the big-endian 16-bit pairs modulo 65536; an odd last byte is then XORed into the low byte.
std::uint16_t checksum(std::span<const std::uint8_t> body);

}  // namespace arcos
