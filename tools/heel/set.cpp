// heel set: new values for keys of the running heeld's configuration.
#include <string>
#include <vector>

#include "commands.h"
#include "heel/error.h"
#include "operator_client.h"

namespace heel::cli {
namespace {

constexpr double kSetTimeout_s = 10.0;  // it may wait behind a save

struct SetOptions : OperatorOptions {
  std::vector<std::string> assignments;
};

/// A number, true, false or quoted text as they are; anything else is text.
Json value_of(const std::string& text) {
  Json value = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  return value.is_primitive() && !value.is_null() && !value.is_discarded() ? value : Json(text);
}

void run_set(const SetOptions& options) {
  Json values = Json::object();
  for (const std::string& assignment : options.assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == 0 || equals == std::string::npos)
      throw Error("'" + assignment + "' (expected KEY=VALUE, as gate.v_max_m_s=0.3)");
    const std::string key = assignment.substr(0, equals);
    if (values.contains(key)) throw Error(key + ": given twice (expected once)");
    values[key] = value_of(assignment.substr(equals + 1));
  }
  OperatorClient client(options, "set");
  const Json answer = client.ask({{"do", "set"}, {"values", values}}, kSetTimeout_s);
  const std::string changes = changes_text(answer["changes"]);
  print_answer(options, answer,
               changes.empty()
                   ? "nothing has changed: these values are in use already\n"
                   : changes + "in use until heeld is reloaded or restarted; `heel save` keeps it\n");
}

}  // namespace

void add_set_command(CLI::App& app) {
  auto options = std::make_shared<SetOptions>();
  CLI::App* command = app.add_subcommand(
      "set",
      "Gives keys of the running heeld's configuration new values, all of them or none. A limit can\n"
      "only be made tighter than the file has it; docs/configuration.md shows which keys can be set.");
  command->add_option("assignments", options->assignments, "as gate.v_max_m_s=0.3")
      ->required()
      ->type_name("KEY=VALUE");
  add_operator_options(*command, *options);
  command->callback([options] { run_set(*options); });
}

}  // namespace heel::cli
