#include "teach_region.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "heel/error.h"

namespace heel::cli {

Region region_of(const std::vector<int>& roi, const CameraModel& camera) {
  const Region region{roi[0], roi[1], roi[2], roi[3]};
  if (region.x_px < 0 || region.y_px < 0 || region.width_px < 1 || region.height_px < 1 ||
      region.width_px > camera.width_px - region.x_px || region.height_px > camera.height_px - region.y_px) {
    throw Error(fmt::format("--roi: {} (expected X,Y,W,H inside the {}x{} image)", fmt::join(roi, ","),
                            camera.width_px, camera.height_px));
  }
  return region;
}

}  // namespace heel::cli
