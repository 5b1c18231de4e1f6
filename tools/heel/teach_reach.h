// Measures and prints how far a taught shirt will be found.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "heel/camera_model.h"
#include "heel/shirt_template.h"
#include "vision/reach/template_reach.h"

namespace heel::cli {

/// Ends after `longest_s` with what it has measured by then.
TemplateReach measured_reach(const ShirtTemplate& shirt, const CameraModel& robot_camera, double longest_s);

/// "found from 1 to 4 m facing away, to 60° at 2 m"
std::string in_one_line(const TemplateReach& reach);
void print_reach(const TemplateReach& reach, double longest_s);
nlohmann::ordered_json reach_json(const TemplateReach& reach);

}  // namespace heel::cli
