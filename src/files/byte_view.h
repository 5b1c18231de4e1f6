// The bytes of a file in memory.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace heel {

using ByteView = std::span<const std::uint8_t>;

inline bool begins_with(ByteView bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::memcmp(bytes.data(), text.data(), text.size()) == 0;
}

}  // namespace heel
