#include "sim/scene/scenario.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "heel/error.h"
#include "sim/scene/scenario_parts.h"
#include "sim/scene/toml_section.h"

namespace heel::sim {

Scenario parse_scenario(const std::string& text, const std::string& path) {
  toml::table table;
  try {
    table = toml::parse(text, path);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw Error(path + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                std::string(error.description()) + " (expected TOML)");
  }
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
  root.finish();
  return scenario;
}

Scenario read_scenario(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(path + ": cannot read (expected a scenario file)");
  std::ostringstream text;
  text << file.rdbuf();
  return parse_scenario(text.str(), path);
}

}  // namespace heel::sim
