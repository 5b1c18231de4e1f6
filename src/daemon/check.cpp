#include "daemon/check.h"

#include <cstdio>

#include "config/config_load.h"
#include "config/config_text.h"
#include "daemon/inputs.h"

namespace heel {

std::string verdict_line(const TemplateVerdict& verdict) {
  char text[160];
  std::snprintf(text, sizeof text,
                "%d features over %.0f %% of the region, %.0f %% alike, %.0f %% left at twice the distance",
                verdict.features, 100.0 * verdict.spread, 100.0 * verdict.self_similarity,
                100.0 * verdict.coarse_share);
  return text;
}

void check_configuration(const std::string& path) {
  const LoadedConfig loaded = load_config(path);
  std::fputs(config_listing(loaded).c_str(), stdout);
  const Inputs inputs = load_inputs(loaded.config);
  std::printf("%s: %d×%d pixels, fx %.1f, fy %.1f\n", loaded.config.camera.info.c_str(),
              inputs.camera.width_px, inputs.camera.height_px, inputs.camera.fx, inputs.camera.fy);
  std::printf("%s: taken at %.2f m; %s\n", loaded.config.target.shirt.c_str(), inputs.shirt.distance_m,
              verdict_line(inputs.verdict).c_str());
  std::printf("%s: good\n", path.c_str());
}

}  // namespace heel
