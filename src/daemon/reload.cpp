#include "daemon/reload.h"

#include <spdlog/spdlog.h>

#include "daemon/inputs.h"
#include "logging/logging.h"

namespace heel {
namespace {

constexpr TimeNs kReloadTimeout_ns = kNsPerS;

}  // namespace

bool reload_configuration(LoadedConfig& loaded, const CameraModel& camera, ControlLoop& control) {
  try {
    LoadedConfig changed = load_config(loaded.file);
    check_against_camera(changed.config, camera);
    const auto fixed_keys = keys_needing_restart(loaded.config, changed.config);
    for (const auto& key : fixed_keys) {
      spdlog::error("{}: {} cannot change while running; restart heeld to change it", loaded.file, key);
    }
    if (!fixed_keys.empty()) return false;
    if (!control.reconfigure(changed.config, kReloadTimeout_ns)) {
      spdlog::error("the control loop did not take the new configuration within {:.1f} s",
                    seconds_from_ns(kReloadTimeout_ns));
      return false;
    }
    set_log_level(changed.config.runtime.log_level);
    loaded = std::move(changed);
    return true;
  } catch (const ConfigError& error) {
    for (const auto& line : error.lines()) spdlog::error("{}", line);
  } catch (const Error& error) {
    spdlog::error("{}", error.what());
  }
  return false;
}

}  // namespace heel
