// The running daemon: wires the stages to their threads and looks after them until it is told to stop.
#pragma once

#include <string>

namespace heel {

/// Runs until SIGTERM, SIGINT, the end of a file camera, or a fatal error. The robot is stopped and closed on
/// every one of these ways. Returns the exit status. Throws ConfigError or Error before anything has started.
int run_daemon(const std::string& config_path);

}  // namespace heel
