// heel bench: what is measured, each kind a subcommand of its own.
#include "commands.h"

namespace heel::cli {

void add_bench_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("bench", "Measures heel beside its yardsticks; never fails for being slow");
  command->require_subcommand(1);
  add_bench_vision_command(*command);
}

}  // namespace heel::cli
