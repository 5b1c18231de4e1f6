// Calibrations and templates of a camera whose pictures are turned (core/picture_turn.h).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/picture_turn.h"
#include "heel/camera_model.h"
#include "heel/shirt_template.h"

namespace heel {

/// The camera that would take the turned pictures.
CameraModel turned_camera(const CameraModel& camera, const PictureTurn& turn);
/// The template that would be taught from the turned pictures.
ShirtTemplate turned_template(const ShirtTemplate& shirt, const PictureTurn& turn);

struct TurnedTemplates {
  std::vector<ShirtTemplate> shirts;
  std::vector<std::size_t> taught;  ///< one for each: which of the given templates it is
};

/// The templates for pictures of `camera` that are turned. Those of another camera stay as they are, and
/// those that are said to be upright. One that was taught with this calibration, and of which nothing is
/// said, may have been taught from pictures as the mounted camera sends them, or before the camera was
/// mounted: its place has the one that is turned with the pictures, and the one as it is follows after all
/// templates (of the first template, it is_first for those).
TurnedTemplates templates_for_turned(std::span<const ShirtTemplate> shirts, const CameraModel& camera,
                                     const PictureTurn& turn);

}  // namespace heel
