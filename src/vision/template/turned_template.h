// Calibrations and templates of a camera whose pictures are turned (core/picture_turn.h).
#pragma once

#include "core/picture_turn.h"
#include "heel/camera_model.h"
#include "heel/shirt_template.h"

namespace heel {

/// The camera that would take the turned pictures.
CameraModel turned_camera(const CameraModel& camera, const PictureTurn& turn);
/// The template that would be taught from the turned pictures.
ShirtTemplate turned_template(const ShirtTemplate& shirt, const PictureTurn& turn);

/// The template for pictures of `camera` that are turned. One that was taught from pictures as this camera
/// sends them is turned like them; any other is returned as it is, also one whose pictures were turned
/// before.
ShirtTemplate template_for_turned(const ShirtTemplate& shirt, const CameraModel& camera,
                                  const PictureTurn& turn);

}  // namespace heel
