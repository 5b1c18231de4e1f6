// A further picture of the taught back, as one more view of the template: its features are found where those
// of made views may not be, since it shows the real cloth and light of a turned back.
//
// Convention: that of heel::FurtherView. Units: pixels.
#pragma once

#include "heel/shirt_template.h"
#include "vision/pose/back_surface.h"
#include "vision/pose/template_view.h"

namespace heel {

/// At most `max_features` of the picture's features on the visible part of the region, strongest first, each
/// carried to the reference view by the picture's pose and `surface`.
TemplateView further_view(const ShirtTemplate& shirt, const BackSurface& surface, const FurtherView& further,
                          int max_features);

}  // namespace heel
