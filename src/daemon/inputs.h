// The files that a configuration refers to: the camera's calibration and the template, loaded and checked
// against each other before any thread starts.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "config/config_load.h"
#include "core/config.h"
#include "heel/camera_model.h"
#include "heel/shirt_template.h"
#include "operator/web/view_facts.h"

namespace heel {

struct Inputs {
  CameraModel camera;
  std::vector<std::string> warnings;      ///< of the files, one line each
  std::vector<ShirtTemplate> shirts;      ///< templates_for_turned() of read_templates()
  std::vector<std::size_t> taught;        ///< one for each: its place in read_templates()
  std::vector<TemplateVerdict> verdicts;  ///< one for each
};

/// Throws heel::Error with one line that names the file and what is wrong with it.
Inputs load_inputs(const Config& config);

/// Checks the values that depend on the camera, also those of a reload. Throws heel::Error.
void check_against_camera(const Config& config, const CameraModel& camera);

/// One line about each template: its file, its distance, its features, their spread and their similarity.
std::vector<std::string> template_lines(const Config& config, const Inputs& inputs);

/// For the page.
ViewFacts view_facts(const Inputs& inputs);

/// Logs the inputs and the limits that the daemon runs with.
void log_configuration(const LoadedConfig& loaded, const Inputs& inputs);

}  // namespace heel
