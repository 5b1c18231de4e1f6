#include "commandline/program_text.h"

#include <fmt/format.h>

#include "commandline/option_rows.h"

namespace heel::commandline {
namespace {

constexpr std::size_t kNameWidth = 34;

/// As CLI11 prints help, but of each command in the list its first sentence only.
class HelpFormatter final : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kNameWidth); }
  std::string make_subcommand(const CLI::App* command) const override {
    return fmt::format("  {:<{}}{}\n", command->get_name(), kNameWidth - 2,
                       first_sentence(command->get_description()));
  }
};

std::string footer_of(const CommandText& command, const std::vector<ExitStatus>& of_program) {
  std::string text;
  if (!command.examples.empty()) text += "Examples:\n";
  for (const Example& example : command.examples)
    text += fmt::format("  {}\n      {}\n", example.line, example.does);
  text += "Exit status: ";
  const auto& statuses = command.exit_statuses.empty() ? of_program : command.exit_statuses;
  for (std::size_t i = 0; i < statuses.size(); ++i)
    text += fmt::format("{}{} {}", i == 0 ? "" : "; ", statuses[i].status, statuses[i].meaning);
  return text + ".";
}

void add_footers(CLI::App& app, const std::string& path, const ProgramText& text) {
  const auto found = text.commands.find(path);
  if (found != text.commands.end()) app.footer(footer_of(found->second, text.exit_statuses));
  for (CLI::App* command : app.get_subcommands({}))
    add_footers(*command, path.empty() ? command->get_name() : path + " " + command->get_name(), text);
}

}  // namespace

void add_program_text(CLI::App& app, const ProgramText& text) {
  app.name(text.name);
  app.description(text.name + ": " + text.summary);
  app.set_version_flag("--version", text.name + " " HEEL_VERSION, "Print the version and exit");
  app.add_flag_callback(
      "--print-man", [&app, &text] { throw CLI::CallForVersion(man_page(app, text), 0); },
      "Print the man page and exit");
  app.add_option_function<std::string>(
         "--print-completion",
         [&app, &text](const std::string& shell) {
           throw CLI::CallForVersion(shell == "bash" ? bash_completion(app, text) : zsh_completion(app, text),
                                     0);
         },
         "Print the script by which this shell completes the command line, and exit")
      ->type_name("SHELL")
      ->check(CLI::IsMember({"bash", "zsh"}));
  app.formatter(std::make_shared<HelpFormatter>());
  for (CLI::App* command : app.get_subcommands({})) command->formatter(app.get_formatter());
  add_footers(app, "", text);
}

}  // namespace heel::commandline
