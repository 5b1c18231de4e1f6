#include "capture/factory/source_address.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "heel/error.h"

namespace heel {

namespace {

constexpr std::array<std::pair<const char*, SourceKind>, 4> kKinds{{
    {"v4l2", SourceKind::V4l2},
    {"libcamera", SourceKind::Libcamera},
    {"file", SourceKind::File},
    {"sim", SourceKind::Sim},
}};

[[noreturn]] void refuse(const std::string& address, const std::string& why) {
  throw Error(fmt::format("camera address '{}': {} (expected v4l2:PATH, libcamera:ID, file:PATH or sim:NAME)",
                          address, why));
}

}  // namespace

SourceAddress parse_source_address(const std::string& address) {
  const std::size_t colon = address.find(':');
  if (colon == std::string::npos) refuse(address, "no kind before a colon");
  const std::string kind = address.substr(0, colon);
  for (const auto& [name, value] : kKinds) {
    if (kind != name) continue;
    std::string rest = address.substr(colon + 1);
    if (rest.empty()) refuse(address, "nothing after the colon");
    return {value, std::move(rest)};
  }
  if (address.find("://") != std::string::npos) refuse(address, "heel reads no stream from a network");
  refuse(address, fmt::format("unknown kind '{}'", kind));
}

}  // namespace heel
