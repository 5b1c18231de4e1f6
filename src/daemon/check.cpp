#include "daemon/check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "config/config_load.h"
#include "config/config_table.h"
#include "config/config_text.h"
#include "daemon/inputs.h"
#include "heel/error.h"
#include "operator/mqtt/broker_login.h"
#include "operator/web/config_json.h"
#include "operator/web/exposure.h"

namespace heel {
namespace {

using Json = nlohmann::ordered_json;

Json keys_of(const LoadedConfig& loaded) {
  Json keys = Json::array();
  for (std::size_t i = 0; i < config_keys().size(); ++i) {
    const ConfigKey& key = config_keys()[i];
    keys.push_back({{"key", key.full_name()},
                    {"value", config_value_json(key, loaded.config)},
                    {"line", loaded.line_of[i]}});
  }
  return keys;
}

/// Throws as check_configuration does.
void add_what_it_holds(Json& answer, const std::string& path) {
  const LoadedConfig loaded = load_config(path);
  const Inputs inputs = load_inputs(loaded.config);
  answer["keys"] = keys_of(loaded);
  answer["camera"] = {{"file", loaded.config.camera.info},
                      {"width_px", inputs.camera.width_px},
                      {"height_px", inputs.camera.height_px},
                      {"fx", inputs.camera.fx},
                      {"fy", inputs.camera.fy}};
  answer["warnings"] = inputs.warnings;
  answer["templates"] = template_lines(loaded.config, inputs);
  answer["page"] = page_exposure(loaded.config.view);
  answer["mqtt"] = mqtt_exposure(loaded.config.mqtt);
}

}  // namespace

void check_configuration(const std::string& path) {
  const LoadedConfig loaded = load_config(path);
  fmt::print("{}", config_listing(loaded));
  const Inputs inputs = load_inputs(loaded.config);
  fmt::print("{}: {}×{} pixels, fx {:.1f}, fy {:.1f}\n", loaded.config.camera.info, inputs.camera.width_px,
             inputs.camera.height_px, inputs.camera.fx, inputs.camera.fy);
  for (const std::string& warning : inputs.warnings) fmt::print("warning: {}\n", warning);
  for (const std::string& line : template_lines(loaded.config, inputs)) fmt::print("{}\n", line);
  for (const std::string& exposure : {page_exposure(loaded.config.view), mqtt_exposure(loaded.config.mqtt)})
    if (!exposure.empty()) fmt::print("{}\n", exposure);
  fmt::print("{}: valid\n", path);
}

CheckAnswer check_configuration_as_json(const std::string& path) {
  std::vector<std::string> errors;
  Json answer{{"file", path}};
  try {
    add_what_it_holds(answer, path);
  } catch (const ConfigError& error) {
    errors = error.lines();
  } catch (const Error& error) {
    errors = {error.what()};
  }
  answer["valid"] = errors.empty();
  answer["errors"] = errors;
  return {errors.empty(), answer.dump(2)};
}

}  // namespace heel
