// Flow structs out of JSON.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "heel/error.h"
#include "recording/field_kinds.h"
#include "recording/flow_fields.h"
#include "recording/flow_json.h"

namespace heel {
namespace {

using namespace field;
using Json = nlohmann::ordered_json;

/// Every field of one object.
class ObjectReader {
 public:
  ObjectReader(const Json& object, std::string path, std::set<std::string>& other_version)
      : object_(object), path_(std::move(path)), other_version_(other_version) {
    if (!object.is_object()) throw Error(path_ + ": no object");
    if (const auto found = object.find("not_finite"); found != object.end()) not_finite_ = &*found;
  }

  void operator()(const char* name, auto& field) { take(name, field); }
  template <typename C, typename B>
  void operator()(const char* name, CountedBytes<C, B> field) {
    take(name, field);
  }
  /// After the last field: what the struct does not have.
  void end() {
    if (taken_ + (not_finite_ != nullptr) == object_.size()) return;
    for (const auto& [name, value] : object_.items())
      if (name != "not_finite" && !names_.contains(name)) other_version_.insert(inner(name));
  }

 private:
  void take(const char* name, auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    names_.insert(name);
    const auto found = object_.find(name);
    if (found != object_.end()) {
      ++taken_;
      read(*found, name, field);
      return;
    }
    if constexpr (std::same_as<Field, double> || Numbers<Field>) {
      if (not_finite_ != nullptr && not_finite_->is_object() && not_finite_->contains(name))
        return read_not_finite((*not_finite_)[name], name, field);
    }
    other_version_.insert(inner(name));
  }
  std::string inner(std::string_view name) const { return fmt::format("{}.{}", path_, name); }
  [[noreturn]] void refuse(std::string_view name, const Json& value, std::string_view expected) const {
    throw Error(fmt::format("{}: {} (expected {})", inner(name),
                            value.dump(-1, ' ', true, Json::error_handler_t::replace), expected));
  }

  void read(const Json& json, const char* name, Flag auto& field) const {
    if (!json.is_boolean()) refuse(name, json, "true or false");
    field = json.get<bool>();
  }
  template <Whole Field>
  void read(const Json& json, const char* name, Field& field) const {
    const bool negative = json.is_number_integer() && !json.is_number_unsigned();
    if (negative && json.get<std::int64_t>() < 0) {
      const auto value = json.get<std::int64_t>();
      if (!std::in_range<Field>(value)) refuse(name, json, "a whole number in range");
      field = static_cast<Field>(value);
      return;
    }
    if (!json.is_number_unsigned() || !std::in_range<Field>(json.get<std::uint64_t>()))
      refuse(name, json, "a whole number in range");
    field = static_cast<Field>(json.get<std::uint64_t>());
  }
  void read(const Json& json, const char* name, double& field) const {
    if (!json.is_number()) refuse(name, json, "a number");
    field = json.get<double>();
  }
  template <Named Field>
  void read(const Json& json, const char* name, Field& field) const {
    if (json.is_string()) {
      for (int i = 0; text_of<Field>(i) != nullptr; ++i) {
        if (json.get_ref<const std::string&>() != text_of<Field>(i)) continue;
        field = static_cast<Field>(i);
        return;
      }
    }
    refuse(name, json, "a name that this version knows");
  }
  void read(const Json& json, const char* name, Chars auto& field) const {
    if (!json.is_string()) refuse(name, json, "a text");
    const auto& text = json.get_ref<const std::string&>();
    field.fill('\0');
    text.copy(field.data(), field.size() - 1);  // it ends with a zero
  }
  template <typename C, typename B>
  void read(const Json& json, const char* name, CountedBytes<C, B>& field) const {
    const std::string text = json.is_string() ? json.get<std::string>() : "?";
    if (text.size() % 2 != 0 || text.size() / 2 > field.bytes.size() ||
        text.find_first_not_of("0123456789abcdef") != std::string::npos)
      refuse(name, json, fmt::format("at most {} bytes as hexadecimal text", field.bytes.size()));
    field.count = static_cast<C>(text.size() / 2);
    for (std::size_t i = 0; i < text.size() / 2; ++i)
      std::from_chars(text.data() + 2 * i, text.data() + 2 * i + 2, field.bytes[i], 16);
  }
  void read(const Json& json, const char* name, Struct auto& field) const {
    ObjectReader reader(json, inner(name), other_version_);
    fields(reader, field);
    reader.end();
  }
  template <typename Array>
  requires Numbers<Array> || Structs<Array>
  void read(const Json& json, const char* name, Array& field) const {
    if (!json.is_array()) refuse(name, json, "a list");
    if (json.size() != field.size()) other_version_.insert(inner(name));
    for (std::size_t i = 0; i < std::min<std::size_t>(json.size(), field.size()); ++i)
      read(json[i], name, field[i]);
  }
  void read_not_finite(const Json& json, const char* name, double& field) const {
    std::array<double, 1> one{};
    read_not_finite(json, name, one);
    field = one[0];
  }
  void read_not_finite(const Json& json, const char* name, Numbers auto& field) const {
    const std::string text = json.is_string() ? json.get<std::string>() : "?";
    const char* at = text.data();
    const char* const end = at + text.size();
    for (double& value : field) {
      if (at != text.data() && at != end) ++at;  // the space
      const auto [next, error] = std::from_chars(at, end, value);
      if (error != std::errc()) refuse(name, json, "numbers, inf, -inf or nan");
      if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
      at = next;
    }
    if (at != end) refuse(name, json, fmt::format("{} numbers", field.size()));
  }

  const Json& object_;
  const std::string path_;
  std::set<std::string>& other_version_;
  const Json* not_finite_ = nullptr;
  std::set<std::string_view> names_;
  std::size_t taken_ = 0;
};

}  // namespace

template <typename Flow>
Flow flow_from_json(std::string_view json, std::set<std::string>& other_version) {
  const Json object = Json::parse(json, nullptr, /*allow_exceptions=*/false);
  if (object.is_discarded()) throw Error("no JSON text");
  Flow record;
  ObjectReader reader(object, "", other_version);
  fields(reader, record);
  reader.end();
  return record;
}

template TickRecord flow_from_json(std::string_view, std::set<std::string>&);
template PoseEstimate flow_from_json(std::string_view, std::set<std::string>&);
template CaptureCounters flow_from_json(std::string_view, std::set<std::string>&);
template Event flow_from_json(std::string_view, std::set<std::string>&);
template WireBytes flow_from_json(std::string_view, std::set<std::string>&);
template FrameTiming flow_from_json(std::string_view, std::set<std::string>&);

}  // namespace heel
