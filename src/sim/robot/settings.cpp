#include "sim/robot/settings.h"

#include <algorithm>

#include "models/robot_models.h"

namespace heel::sim {

P3AtSettings::P3AtSettings() : model(robot_models().front()) {}

P3AtSettings settings_of_model(const std::string& subclass) {
  P3AtSettings settings;
  use_model(subclass, settings);
  return settings;
}

void use_model(const std::string& subclass, P3AtSettings& settings) {
  const double track_before_m = settings.model.effective_track_m;
  settings.model = robot_model(subclass);
  settings.subtype = settings.model.subclass;
  const bool is_new = settings.model.subclass.ends_with("-sh");
  settings.heading_from_zero = !is_new;
  settings.sends_fault_flags = is_new;
  settings.chassis.effective_track_m = settings.model.effective_track_m;
  settings.chassis.track_scale *= settings.model.effective_track_m / track_before_m;
  settings.translation_top.speed = std::min(settings.translation_top.speed, settings.model.v_max_mm_s * 1e-3);
  settings.rotation_top_deg.speed =
      std::min(settings.rotation_top_deg.speed, static_cast<double>(settings.model.yaw_rate_max_deg_s));
}

}  // namespace heel::sim
