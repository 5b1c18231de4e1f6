// The JSON Schema of flow structs.
#include <nlohmann/json.hpp>
#include <string>

#include "recording/field_kinds.h"
#include "recording/flow_fields.h"
#include "recording/flow_json.h"

namespace heel {
namespace {

using namespace field;
using SchemaJson = nlohmann::ordered_json;

class SchemaWriter {
 public:
  void operator()(const char* name, const auto& field) {
    using Field = std::remove_cvref_t<decltype(field)>;
    schema_["properties"][name] = type_of(field);
    if constexpr (!std::same_as<Field, double> && !Numbers<Field>) schema_["required"].push_back(name);
  }
  template <typename Flow>
  static SchemaJson object(const Flow& record) {
    SchemaWriter writer;
    writer.schema_["type"] = "object";
    fields(writer, record);
    writer.schema_["properties"]["not_finite"] = {
        {"type", "object"},
        {"description", "the fields left out because they are inf, -inf or nan"},
        {"properties", SchemaJson::object()}};
    return writer.schema_;
  }

 private:
  static SchemaJson type_of(Flag auto) { return {{"type", "boolean"}}; }
  static SchemaJson type_of(Whole auto) { return {{"type", "integer"}}; }
  static SchemaJson type_of(double) { return {{"type", "number"}}; }
  template <Named Field>
  static SchemaJson type_of(Field) {
    SchemaJson names = SchemaJson::array();
    for (int i = 0; text_of<Field>(i) != nullptr; ++i) names.push_back(text_of<Field>(i));
    return {{"type", "string"}, {"enum", names}};
  }
  static SchemaJson type_of(const Chars auto&) { return {{"type", "string"}}; }
  template <typename C, typename B>
  static SchemaJson type_of(const CountedBytes<C, B>&) {
    return {{"type", "string"}, {"description", "hexadecimal"}};
  }
  static SchemaJson type_of(const Struct auto& field) { return object(field); }
  template <typename Array>
  requires Numbers<Array> || Structs<Array>
  static SchemaJson type_of(const Array& field) { return {{"type", "array"}, {"items", type_of(field[0])}}; }

  SchemaJson schema_;
};

}  // namespace

void append_json_text(std::string& json, std::string_view text) {
  json += SchemaJson(text).dump(-1, ' ', false, SchemaJson::error_handler_t::replace);
}

template <typename Flow>
std::string flow_json_schema(const std::string& title) {
  SchemaJson schema = SchemaWriter::object(Flow{});
  schema["title"] = title;
  return schema.dump();
}

template std::string flow_json_schema<TickRecord>(const std::string&);
template std::string flow_json_schema<PoseEstimate>(const std::string&);
template std::string flow_json_schema<CaptureCounters>(const std::string&);
template std::string flow_json_schema<Event>(const std::string&);
template std::string flow_json_schema<WireBytes>(const std::string&);
template std::string flow_json_schema<FrameTiming>(const std::string&);

}  // namespace heel
