// heel status: what the running heeld does, and why.
#include "commands.h"
#include "operator_client.h"
#include "status_text.h"

namespace heel::cli {
namespace {

constexpr double kStatusTimeout_s = 2.0;

void run_status(const OperatorOptions& options) {
  OperatorClient client(options, "status");
  const Json status = client.ask({{"do", "status"}}, kStatusTimeout_s);
  print_answer(options, status, status_text(status));
}

}  // namespace

void add_status_command(CLI::App& app) {
  auto options = std::make_shared<OperatorOptions>();
  CLI::App* command = app.add_subcommand("status", "Shows what the running heeld does and why");
  add_operator_options(*command, *options);
  command->callback([options] { run_status(*options); });
}

}  // namespace heel::cli
