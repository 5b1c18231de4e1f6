// The daemon: load, wire, start, run, stop.
#pragma once

#include <string>

namespace heel {

/// Runs until SIGTERM, SIGINT, the end of a file camera, or a fatal error. In each case the robot is stopped
/// and its session closed. Returns the exit status. Throws ConfigError or Error before any thread has
/// started.
int run_daemon(const std::string& config_path);

}  // namespace heel
