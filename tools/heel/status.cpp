// heel status: what the running heeld does, and why.
#include <iostream>

#include "commands.h"
#include "operator_client.h"
#include "status_text.h"

namespace heel::cli {
namespace {

constexpr double kStatusTimeout_s = 2.0;

struct StatusOptions : OperatorOptions {
  bool json = false;
};

void run_status(const StatusOptions& options) {
  OperatorClient client(options.socket, "status");
  const Json status = client.ask({{"do", "status"}}, kStatusTimeout_s);
  std::cout << (options.json ? status.dump() + "\n" : status_text(status));
}

}  // namespace

void add_status_command(CLI::App& app) {
  auto options = std::make_shared<StatusOptions>();
  CLI::App* command = app.add_subcommand("status", "Shows what the running heeld does and why");
  command->add_flag("--json", options->json, "one JSON object (docs/operator.md)");
  add_operator_options(*command, *options);
  command->callback([options] { run_status(*options); });
}

}  // namespace heel::cli
