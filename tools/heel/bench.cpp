// heel bench: measurements, each kind with a subcommand of its own.
#include "commands.h"

namespace heel::cli {

void add_bench_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("bench", "Measures heel and what it is compared with; slow results are no error");
  command->require_subcommand(1);
  add_bench_vision_command(*command);
  add_bench_control_command(*command);
  add_bench_daemon_command(*command);
}

}  // namespace heel::cli
