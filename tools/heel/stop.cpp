// heel stop: a command to the running heeld.
#include "commands.h"
#include "operator_client.h"

namespace heel::cli {

void add_stop_command(CLI::App& app) {
  add_operator_command(app, "stop", "Brings the robot to rest; it then needs a start");
}

}  // namespace heel::cli
