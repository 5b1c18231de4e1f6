// Readers for the sections of a scenario file. All throw heel::Error with the place in the file.
#pragma once

#include <string>

#include "core/angles.h"
#include "sim/scene/scenario.h"
#include "toml/toml_section.h"

namespace heel::sim {

inline constexpr NumberRange kMetres{-1000, 1000, "m"};
inline constexpr NumberRange kTurn_deg{-720, 720, "deg"};
inline constexpr NumberRange kShare{0, 1, ""};

/// [person], with its [[person.path]]
void read_target(TomlSection person, Scenario& scenario);
/// One [[passerby]]
PasserbySettings read_passerby(TomlSection passerby);
/// [camera]
void read_camera(TomlSection camera, const std::string& scenario_path, ScenarioCamera& out);
/// [robot], with its [[robot.floor]]
void read_robot(TomlSection robot, ScenarioRobot& out);
/// [room], [light] with its [[light.change]]
void read_room(TomlSection room, RoomSettings& out);
void read_light(TomlSection light, LightSettings& out);
/// One [[obstacle]]
ObstacleSettings read_obstacle(TomlSection obstacle);

}  // namespace heel::sim
