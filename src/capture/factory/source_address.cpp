#include "capture/factory/source_address.h"

#include <array>
#include <utility>

#include "heel/error.h"

namespace heel {

namespace {

constexpr const char* kExpected = "expected v4l2:PATH, libcamera:ID, file:PATH or sim:NAME";

constexpr std::array<std::pair<const char*, SourceKind>, 4> kKinds{{
    {"v4l2", SourceKind::V4l2},
    {"libcamera", SourceKind::Libcamera},
    {"file", SourceKind::File},
    {"sim", SourceKind::Sim},
}};

}  // namespace

SourceAddress parse_source_address(const std::string& address) {
  const std::size_t colon = address.find(':');
  if (colon == std::string::npos) {
    throw Error("camera address '" + address + "': no kind before a colon; " + kExpected);
  }
  const std::string kind = address.substr(0, colon);
  for (const auto& [name, value] : kKinds) {
    if (kind != name) continue;
    std::string rest = address.substr(colon + 1);
    if (rest.empty()) {
      throw Error("camera address '" + address + "': nothing after the colon; " + kExpected);
    }
    return {value, std::move(rest)};
  }
  throw Error("camera address '" + address + "': unknown kind '" + kind + "'; " + kExpected);
}

}  // namespace heel
