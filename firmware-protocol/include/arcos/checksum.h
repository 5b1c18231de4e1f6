// The ARCOS checksum over a packet's body (id and payload, without header, count and checksum).
#pragma once

#include <cstdint>
#include <span>

namespace arcos {

/// Sum of the big-endian 16-bit pairs modulo 65536; an odd last byte is then XORed into the low byte.
/// It is weak: swapping two pairs, or errors in two pairs that cancel in the sum, go unnoticed.
std::uint16_t checksum(std::span<const std::uint8_t> body);

}  // namespace arcos
