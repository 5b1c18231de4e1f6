#include "sim/live/reference_picture.h"

#include <fmt/format.h>

#include "files/image_file.h"
#include "sim/scene/world.h"

namespace heel::sim {

void write_reference_picture(const Scenario& scenario, const std::string& path, double distance_m) {
  const ReferenceView view = World(scenario).reference_view(distance_m);
  write_grey_image(path, view.grey.data(), scenario.camera.model.width_px, scenario.camera.model.height_px);
  fmt::print("roi={},{},{},{} distance={:g}\n", view.roi.x_px, view.roi.y_px, view.roi.width_px,
             view.roi.height_px, view.distance_m);
}

}  // namespace heel::sim
