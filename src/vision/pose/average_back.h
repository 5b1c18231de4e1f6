// The surfaces that the template's region can be: a plane, as of a picture or a board, or the average back.
#pragma once

#include "heel/vision_config.h"
#include "vision/pose/back_surface.h"
#include "vision/template/reference_view.h"

namespace heel {

/// The plane of the paper. If the reference view's distance is unknown, its departures are, too: they are 0.
BackSurface flat_surface(const ReferenceView& reference, const VisionConfig& config);

/// The average of real backs, its depths scaled with VisionConfig::back_curvature_1_m; 0: a plane. If the
/// reference view's distance is unknown, the shape in units of the distance is unknown, too: a plane.
BackSurface average_back(const ReferenceView& reference, const VisionConfig& config);

}  // namespace heel
