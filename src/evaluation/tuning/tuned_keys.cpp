#include "evaluation/tuning/tuned_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <variant>

#include "config/config_table.h"
#include "heel/error.h"

namespace heel::evaluation {
namespace {

using RealField = double* (*)(Config&);

/// Without the limits of comfort and of the picture, which are for people to decide.
std::vector<std::string> keys_of_law(std::string_view law) {
  if (law == "trail")
    return {"control.gain_distance_1_s", "control.trail_reach_m", "control.trail_smooth_m",
            "control.bearing_gain_1_s"};
  if (law == "position") return {"control.gain_distance_1_s", "control.gain_lateral_rad_s_m"};
  return {"control.gain_distance_1_s", "control.gain_lateral_rad_s_m", "control.gain_yaw_1_s",
          "control.bearing_gain_1_s"};
}

std::string known_keys() {
  std::string text;
  for (const ConfigKey& key : config_keys())
    if (key.section == "control" && key.can_be_set() && std::holds_alternative<RealField>(key.field))
      text += (text.empty() ? "" : ", ") + key.full_name();
  return text;
}

TunedKey tuned_key(const Config& config, const std::string& name, double factor) {
  const auto index = index_of_key(name);
  if (!index) throw Error(fmt::format("{}: no key of this name (expected one of {})", name, known_keys()));
  const ConfigKey& key = config_keys()[*index];
  if (key.section != "control" || !key.can_be_set() || !std::holds_alternative<RealField>(key.field))
    throw Error(fmt::format("{}: cannot be tuned (expected one of {})", name, known_keys()));
  TunedKey tuned{*index, 0.0, 0.0};
  const double value = value_of(tuned, config);
  if (value == 0.0)
    throw Error(fmt::format("{}: is 0 in the configuration (expected a value to begin with)", name));
  const auto [low, high] = std::minmax({value / factor, value * factor});
  tuned.low = std::max(low, key.min);
  tuned.high = std::min(high, key.max);
  return tuned;
}

}  // namespace

std::string TunedKey::name() const {
  return config_keys()[index].full_name();
}

std::vector<TunedKey> tuned_keys(const Config& config, const std::vector<std::string>& names, double factor) {
  std::vector<TunedKey> keys;
  for (const std::string& name : names.empty() ? keys_of_law(config.control.law) : names) {
    keys.push_back(tuned_key(config, name, factor));
    for (std::size_t i = 0; i + 1 < keys.size(); ++i)
      if (keys[i].index == keys.back().index) throw Error(name + ": given twice (expected once)");
  }
  return keys;
}

double value_of(const TunedKey& key, const Config& config) {
  Config copy = config;
  return *std::get<RealField>(config_keys()[key.index].field)(copy);
}

Config with_values(Config config, std::span<const TunedKey> keys, std::span<const double> values) {
  for (std::size_t i = 0; i < keys.size(); ++i)
    *std::get<RealField>(config_keys()[keys[i].index].field)(config) = values[i];
  return config;
}

bool relations_hold(const Config& config) {
  return std::ranges::all_of(config_relations(),
                             [&](const ConfigRelation& relation) { return relation.holds(config); });
}

}  // namespace heel::evaluation
