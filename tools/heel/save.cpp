// heel save: what was set, into the configuration file of the running heeld.
#include "commands.h"
#include "operator_client.h"

namespace heel::cli {
namespace {

constexpr double kSaveTimeout_s = 60.0;  // for the disk

void run_save(const OperatorOptions& options) {
  OperatorClient client(options, "save");
  const Json answer = client.ask({{"do", "save"}}, kSaveTimeout_s);
  const std::string changes = changes_text(answer["changes"]);
  print_answer(options, answer, changes.empty() ? "nothing to save: no value was set\n" : changes);
}

}  // namespace

void add_save_command(CLI::App& app) {
  auto options = std::make_shared<OperatorOptions>();
  CLI::App* command = app.add_subcommand(
      "save", "Writes the values that were set into heeld's configuration file; comments and order stay");
  add_operator_options(*command, *options);
  command->callback([options] { run_save(*options); });
}

}  // namespace heel::cli
