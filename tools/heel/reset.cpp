// heel reset: a command to the running heeld.
#include "commands.h"
#include "operator_client.h"

namespace heel::cli {

void add_reset_command(CLI::App& app) {
  add_operator_command(app, "reset",
                       "Ends an emergency stop; after the STOP button it lets the motors be enabled again");
}

}  // namespace heel::cli
