// A new configuration for the running daemon: all of it or nothing.
#pragma once

#include "config/config_load.h"
#include "daemon/control_loop.h"
#include "heel/camera_model.h"

namespace heel {

/// Reads `loaded.file` again and applies it. False: an error in the file, a change that needs a restart, or
/// no answer from the control loop; the reason is logged, and `loaded` and the daemon are unchanged.
bool reload_configuration(LoadedConfig& loaded, const CameraModel& camera, ControlLoop& control);

}  // namespace heel
