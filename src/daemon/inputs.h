// What a configuration refers to: the camera's calibration and the template, loaded and checked against each
// other before any thread starts.
#pragma once

#include "core/config.h"
#include "heel/camera_model.h"
#include "heel/shirt_template.h"

namespace heel {

struct Inputs {
  CameraModel camera;
  ShirtTemplate shirt;  ///< with target.distance_m applied
  TemplateVerdict verdict;
};

/// Throws heel::Error with one line naming the file and what is wrong with it.
Inputs load_inputs(const Config& config);

/// What of a configuration depends on the camera; throws heel::Error. Also for reloads.
void check_against_camera(const Config& config, const CameraModel& camera);

}  // namespace heel
