// Bytes of any number as WireBytes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "heel/flow.h"

namespace heel {

/// Calls `take(piece)` for as many as it needs; for none when there are no bytes.
template <typename Take>
void for_each_wire_piece(std::span<const std::uint8_t> bytes, bool to_robot, TimeNs t_ns, const Take& take) {
  while (!bytes.empty()) {
    WireBytes piece{.t_ns = t_ns, .to_robot = to_robot};
    const auto part = bytes.first(std::min(bytes.size(), piece.bytes.size()));
    std::copy(part.begin(), part.end(), piece.bytes.begin());
    piece.count = static_cast<std::uint8_t>(part.size());
    take(piece);
    bytes = bytes.subspan(part.size());
  }
}

}  // namespace heel
