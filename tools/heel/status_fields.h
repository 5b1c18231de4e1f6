// Fields of the status of heeld that may be null or missing, as texts.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

#include "operator_client.h"

namespace heel::cli {

/// A number of the status; nothing where it is null or missing.
inline std::optional<double> status_number(const Json& object, std::string_view field) {
  const auto found = object.find(field);
  if (found == object.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

/// A number as `format` writes it, or "unknown".
inline std::string number(const Json& object, std::string_view field, fmt::format_string<double> format) {
  const auto found = object.find(field);
  if (found == object.end() || !found->is_number()) return "unknown";
  return fmt::format(format, found->get<double>());
}

inline bool flag(const Json& object, std::string_view field) {
  const auto found = object.find(field);
  return found != object.end() && found->is_boolean() && found->get<bool>();
}

inline std::string text(const Json& object, std::string_view field) {
  const auto found = object.find(field);
  return found != object.end() && found->is_string() ? found->get<std::string>() : "unknown";
}

inline const Json& part(const Json& status, std::string_view name) {
  static const Json kNone = Json::object();
  const auto found = status.find(name);
  return found == status.end() || !found->is_object() ? kNone : *found;
}

}  // namespace heel::cli
