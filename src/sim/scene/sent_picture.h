// What a camera that is mounted turned or mirrored sends of the world: the scenario keys camera.rotate and
// camera.mirror say what makes it upright.
#pragma once

#include "heel/camera_model.h"
#include "heel/shirt_template.h"
#include "sim/scene/scenario.h"

namespace heel::sim {

/// The calibration of the pictures that it sends.
CameraModel sent_camera(const ScenarioCamera& camera);

/// The reference view as a template of what the camera sends. Throws heel::Error when the back does not fit
/// into the picture.
ShirtTemplate sent_reference_view(const Scenario& scenario, double distance_m);

}  // namespace heel::sim
