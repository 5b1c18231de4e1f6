// heel estop: a command to the running heeld.
#include "commands.h"
#include "operator_client.h"

namespace heel::cli {

void add_estop_command(CLI::App& app) {
  add_operator_command(app, "estop", "Stops the robot at once, from any state; it then needs a reset");
}

}  // namespace heel::cli
