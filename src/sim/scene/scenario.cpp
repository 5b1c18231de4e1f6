#include "sim/scene/scenario.h"

#include <filesystem>

#include "sim/scene/scenario_parts.h"
#include "toml/toml_file.h"
#include "toml/toml_section.h"

namespace heel::sim {

Scenario parse_scenario(const std::string& text, const std::string& path) {
  const toml::table table = parse_toml(text, path);
  TomlSection root(table, "", path);
  Scenario scenario;
  scenario.name = root.text("name", std::filesystem::path(path).stem().string());
  scenario.shows = root.text("shows", "");
  scenario.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0, INT64_MAX));
  scenario.duration_s = root.number("duration_s", scenario.duration_s, {0.1, 86400, "s"});
  scenario.vision_latency_ms = root.number("vision_latency_ms", scenario.vision_latency_ms, {0, 1000, "ms"});
  read_target(root.section("person"), scenario);
  for (TomlSection& passerby : root.sections("passerby"))
    scenario.passers_by.push_back(read_passerby(passerby));
  for (TomlSection& obstacle : root.sections("obstacle"))
    scenario.obstacles.push_back(read_obstacle(obstacle));
  read_camera(root.section("camera"), path, scenario.camera);
  read_robot(root.section("robot"), scenario.robot);
  read_room(root.section("room"), scenario.room);
  read_light(root.section("light"), scenario.light);
  root.reject_unknown_keys();
  return scenario;
}

Scenario read_scenario(const std::string& path) {
  return parse_scenario(read_toml_text(path, "a scenario file"), path);
}

}  // namespace heel::sim
