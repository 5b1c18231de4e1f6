#include "sim/live/still.h"

#include <cstdio>

#include "sim/live/picture_file.h"
#include "sim/scene/world.h"

namespace heel::sim {

void write_still(const Scenario& scenario, const std::string& path, double distance_m) {
  World world(scenario);
  const ReferenceView view = world.reference_view(distance_m);
  write_grey_picture(path, view.grey, scenario.camera.model.width_px, scenario.camera.model.height_px);
  std::printf("roi=%d,%d,%d,%d distance=%g\n", view.roi.x_px, view.roi.y_px, view.roi.width_px,
              view.roi.height_px, view.distance_m);
}

}  // namespace heel::sim
