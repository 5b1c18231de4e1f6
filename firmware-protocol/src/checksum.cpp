#include "arcos/checksum.h"

#include <cstddef>

namespace arcos {

std::uint16_t checksum(std::span<const std::uint8_t> body) {
  std::uint32_t sum = 0;
  std::size_t i = 0;
  for (; i + 1 < body.size(); i += 2) {
    sum += static_cast<std::uint32_t>(body[i]) << 8 | body[i + 1];
  }
  auto folded = static_cast<std::uint16_t>(sum & 0xFFFF);
  if (i < body.size()) folded = static_cast<std::uint16_t>(folded ^ body[i]);
  return folded;
}

}  // namespace arcos
