#include "sim/live/reference_picture.h"

#include <fmt/format.h>

#include "files/image_file.h"
#include "sim/scene/sent_picture.h"

namespace heel::sim {

void write_reference_picture(const Scenario& scenario, const std::string& path, double distance_m) {
  const ShirtTemplate view = sent_reference_view(scenario, distance_m);
  write_grey_image(path, view.grey.data(), view.camera.width_px, view.camera.height_px);
  fmt::print("roi={},{},{},{} distance={:g}\n", view.roi.x_px, view.roi.y_px, view.roi.width_px,
             view.roi.height_px, view.distance_m);
}

}  // namespace heel::sim
