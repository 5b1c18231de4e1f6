// Camera addresses: KIND:REST, e.g. "v4l2:/dev/video0".
#pragma once

#include <cstdint>
#include <string>

namespace heel {

/// The kinds of camera address.
enum class SourceKind : std::uint8_t { V4l2, Libcamera, File, Sim };

struct SourceAddress {
  SourceKind kind = SourceKind::V4l2;
  std::string rest;  ///< path, camera id or channel name
};

/// Parses "v4l2:PATH", "libcamera:ID", "file:PATH" or "sim:NAME". Throws heel::Error, which says what is
/// wrong and what was expected.
SourceAddress parse_source_address(const std::string& address);

}  // namespace heel
