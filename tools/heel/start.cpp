// heel start: a command to the running heeld.
#include "commands.h"
#include "operator_client.h"

namespace heel::cli {

void add_start_command(CLI::App& app) {
  add_operator_command(app, "start", "Lets the robot move: it follows the person as soon as it sees them");
}

}  // namespace heel::cli
