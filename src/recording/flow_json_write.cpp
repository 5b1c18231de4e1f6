// Flow structs into JSON.
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "recording/field_count.h"
#include "recording/field_kinds.h"
#include "recording/flow_fields.h"
#include "recording/flow_json.h"

namespace heel {
namespace {

using namespace field;

struct FieldCounter {
  std::size_t members = 0;
  constexpr void operator()(const char* /*name*/, const auto& field) {
    members += IsCountedBytes<std::remove_cvref_t<decltype(field)>>::value ? 2 : 1;
  }
};

template <typename Flow>
constexpr bool table_is_complete() {
  FieldCounter counter;
  Flow record{};
  fields(counter, record);
  return counter.members == member_count<Flow>();
}
// A struct in include/heel/flow.h has a member that recording/flow_fields.h leaves out.
static_assert(table_is_complete<PoseEstimate>());
static_assert(table_is_complete<Odometry>());
static_assert(table_is_complete<SonarEcho>());
static_assert(table_is_complete<DriveLimits>());
static_assert(table_is_complete<RobotState>());
static_assert(table_is_complete<OperatorRequest>());
static_assert(table_is_complete<ControlInput>());
static_assert(table_is_complete<TargetState>());
static_assert(table_is_complete<VelocityCommand>());
static_assert(table_is_complete<TickRecord>());
static_assert(table_is_complete<CaptureCounters>());
static_assert(table_is_complete<Event>());
static_assert(table_is_complete<WireBytes>());
static_assert(table_is_complete<FrameTiming>());

template <typename Number>
void append_number(std::string& json, Number value) {
  std::array<char, 32> text{};  // the longest, a double, has 24
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  json.append(text.data(), end);
}

void append_double(std::string& json, double value) {
  if (value == 0.0 && std::signbit(value)) {
    json += "-0.0";  // "-0" reads as a whole number, which has no sign of zero
    return;
  }
  append_number(json, value);
}

/// Every field of one object.
class ObjectWriter {
 public:
  explicit ObjectWriter(std::string& json) : json_(json) { json_ += '{'; }

  void operator()(const char* name, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    if constexpr (std::same_as<Field, double>) {
      if (!std::isfinite(field)) return add_not_finite(name, std::array{field});
    } else if constexpr (Numbers<Field>) {
      for (const double value : field)
        if (!std::isfinite(value)) return add_not_finite(name, field);
    }
    begin(name);
    value(field);
  }
  void end() {
    if (!not_finite_.empty()) {
      begin("not_finite");
      json_.append("{").append(not_finite_).append("}");
    }
    json_ += '}';
  }

 private:
  void begin(const char* name) {
    if (json_.back() != '{') json_ += ',';
    json_.append("\"").append(name).append("\":");
  }
  void add_not_finite(const char* name, const auto& values) {
    std::string text;
    for (const double value : values) {
      if (!text.empty()) text += ' ';
      if (std::isnan(value)) {
        text += "nan";  // with its sign it would be another text on another machine
      } else {
        append_number(text, value);
      }
    }
    if (!not_finite_.empty()) not_finite_ += ',';
    not_finite_ += fmt::format("\"{}\":\"{}\"", name, text);
  }
  void value(Flag auto field) { json_ += field ? "true" : "false"; }
  void value(Whole auto field) { append_number(json_, field); }
  void value(double field) { append_double(json_, field); }
  void value(Named auto field) { append_json_text(json_, to_string(field)); }
  void value(const Chars auto& field) {
    const std::string_view all(field.data(), field.size());
    append_json_text(json_, all.substr(0, all.find('\0')));
  }
  template <typename C, typename B>
  void value(const CountedBytes<C, B>& field) {
    json_ += '"';
    for (std::size_t i = 0; i < field.count && i < field.bytes.size(); ++i) {
      constexpr std::string_view kDigits = "0123456789abcdef";
      json_ += kDigits[field.bytes[i] >> 4];
      json_ += kDigits[field.bytes[i] & 15];
    }
    json_ += '"';
  }
  void value(const Struct auto& field) {
    ObjectWriter inner(json_);
    fields(inner, field);
    inner.end();
  }
  template <typename Array>
  requires Numbers<Array> || Structs<Array>
  void value(const Array& field) {
    char before = '[';
    for (const auto& element : field) {
      json_ += before;
      value(element);
      before = ',';
    }
    json_ += ']';
  }

  std::string& json_;
  std::string not_finite_;
};

}  // namespace

template <typename Flow>
void append_flow_json(std::string& json, const Flow& record) {
  ObjectWriter writer(json);
  fields(writer, record);
  writer.end();
}

template void append_flow_json(std::string&, const TickRecord&);
template void append_flow_json(std::string&, const PoseEstimate&);
template void append_flow_json(std::string&, const CaptureCounters&);
template void append_flow_json(std::string&, const Event&);
template void append_flow_json(std::string&, const WireBytes&);
template void append_flow_json(std::string&, const FrameTiming&);

}  // namespace heel
