#include "operator/web/config_json.h"

#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "config/config_value.h"

namespace heel {
namespace {

const char* json_type(const ConfigKey& key) {
  switch (key.field.index()) {
    case 0:
      return "boolean";
    case 1:
      return "integer";
    case 2:
      return "number";
    case 4:
      return "list";
    default:
      return "string";
  }
}

/// What `heel set` may do: null, any value; else the direction that is safer, or none at all.
ViewJson limit_of(const ConfigKey& key) {
  switch (key.tighter) {
    case Tighter::None:
      return nullptr;
    case Tighter::Smaller:
    case Tighter::Larger:
      return "tighter-only";
    case Tighter::Neither:
      break;
  }
  return "file-only";
}

}  // namespace

ViewJson config_value_json(const ConfigKey& key, const Config& config) {
  // The accessors are shared with the parser and take a Config that can be written; this only reads.
  return std::visit([&](auto field) { return ViewJson(*field(const_cast<Config&>(config))); }, key.field);
}

ViewJson config_json(const std::string& file, const SettingsView& settings) {
  static const Config defaults;
  ViewJson keys = ViewJson::array();
  for (const ConfigKey& key : config_keys()) {
    const std::string_view type = json_type(key);
    const bool has_range = type == "number" || type == "integer";
    ViewJson row = {{"key", key.full_name()}, {"section", key.section}, {"type", type}};
    row["value"] = config_value_json(key, settings.in_use);
    row["file_value"] = config_value_json(key, settings.file);
    row["default"] = config_value_json(key, defaults);
    row["min"] = has_range ? ViewJson(key.min) : ViewJson();
    row["max"] = has_range ? ViewJson(key.max) : ViewJson();
    row["unit"] = key.unit;
    row["live"] = key.can_be_set();
    row["limit"] = limit_of(key);
    if (key.tighter == Tighter::Smaller || key.tighter == Tighter::Larger)
      row["safer"] = key.tighter == Tighter::Smaller ? "smaller" : "larger";
    if (!key.choices.empty() && key.text == ConfigText::Choice) row["choices"] = split_choices(key.choices);
    row["effect"] = key.effect;
    keys.push_back(std::move(row));
  }
  return {{"file", file}, {"keys", std::move(keys)}};
}

}  // namespace heel
