// heel mark: a mark in the recording of the running heeld.
#include <string>

#include "commands.h"
#include "operator_client.h"

namespace heel::cli {
namespace {

constexpr double kMarkTimeout_s = 5.0;

struct MarkOptions : OperatorOptions {
  std::string text;
};

void run_mark(const MarkOptions& options) {
  OperatorClient client(options, "mark");
  print_answer(options, client.ask({{"do", "mark"}, {"text", options.text}}, kMarkTimeout_s), "marked\n");
}

}  // namespace

void add_mark_command(CLI::App& app) {
  auto options = std::make_shared<MarkOptions>();
  CLI::App* command = app.add_subcommand("mark", "Puts a mark into the recording of the running heeld");
  command->add_option("text", options->text, "what happened, at most 200 bytes");
  add_operator_options(*command, *options);
  command->callback([options] { run_mark(*options); });
}

}  // namespace heel::cli
