#include "daemon/check.h"

#include <fmt/format.h>

#include <string>

#include "config/config_load.h"
#include "config/config_text.h"
#include "daemon/inputs.h"
#include "operator/web/exposure.h"

namespace heel {

void check_configuration(const std::string& path) {
  const LoadedConfig loaded = load_config(path);
  fmt::print("{}", config_listing(loaded));
  const Inputs inputs = load_inputs(loaded.config);
  fmt::print("{}: {}×{} pixels, fx {:.1f}, fy {:.1f}\n", loaded.config.camera.info, inputs.camera.width_px,
             inputs.camera.height_px, inputs.camera.fx, inputs.camera.fy);
  for (const std::string& line : template_lines(loaded.config, inputs)) fmt::print("{}\n", line);
  const std::string exposure = page_exposure(loaded.config.view);
  if (!exposure.empty()) fmt::print("{}\n", exposure);
  fmt::print("{}: valid\n", path);
}

}  // namespace heel
