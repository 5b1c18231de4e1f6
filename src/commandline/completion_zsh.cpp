// Completion for zsh, with descriptions.
#include <fmt/format.h>

#include "commandline/completion.h"
#include "commandline/option_rows.h"
#include "commandline/program_text.h"

namespace heel::commandline {
namespace {

/// Inside single quotes of the shell, in a description of _arguments and _describe.
std::string zsh_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\'')
      escaped += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      escaped += std::string("\\") + c;
    else
      escaped += c;
  }
  return escaped;
}

/// ":NAME:ACTION" of a value.
std::string zsh_value(const OptionRow& row, const ProgramText& program) {
  const std::string name = zsh_text(row.names.empty() ? row.argument : row.value);
  if (!row.choices.empty()) return fmt::format(":{}:({})", name, joined(row.choices));
  if (const auto values = program.values.find(row.value); values != program.values.end())
    return fmt::format(":{}:compadd -S \"\" {}", name, joined(values->second));
  std::string extension;
  switch (completes(row.value, &extension)) {
    case Completes::Files:
      return fmt::format(":{}:_files{}", name, extension.empty() ? "" : " -g \"*." + extension + "\"");
    case Completes::Folders:
      return fmt::format(":{}:_files -/", name);
    case Completes::Nothing:
      break;
  }
  return fmt::format(":{}:( )", name);
}

/// A line for each name of an option, or for the argument.
std::string specs_of(const OptionRow& row, const ProgramText& program) {
  if (row.names.empty()) return fmt::format("    '{}{}'\n", row.repeats ? "*" : "", zsh_value(row, program));
  const std::string all = joined(row.names);
  std::string text;
  for (const std::string& name : row.names)
    text += fmt::format("    '{}{}[{}]{}'\n", row.repeats ? "*" : "(" + all + ")", name,
                        zsh_text(first_sentence(row.description)),
                        row.value.empty() ? "" : zsh_value(row, program));
  return text;
}

std::string zsh_function(const CommandRow& command, const ProgramText& program) {
  const auto below = command.app->get_subcommands([](const CLI::App*) { return true; });
  std::string specs, descriptions, cases;
  for (const OptionRow& row : option_rows(*command.app)) specs += specs_of(row, program);
  const std::string name = function_name(command.name);
  if (below.empty())
    return fmt::format("{}() {{\n  local -a specs=(\n{}  )\n  _arguments -s $specs\n}}\n\n", name, specs);
  for (const CLI::App* one : below) {
    descriptions +=
        fmt::format("    '{}:{}'\n", one->get_name(), zsh_text(first_sentence(one->get_description())));
    cases += fmt::format("        {}) {} ;;\n", one->get_name(),
                         function_name(command.name + " " + one->get_name()));
  }
  return fmt::format(
      "{}() {{\n  local context state line\n  local -a specs=(\n{}    '1:command:->command'\n    "
      "'*::argument:->argument'\n  )\n  local -a commands=(\n{}  )\n  _arguments -C $specs\n  case $state "
      "in\n    "
      "command) _describe command commands ;;\n    argument)\n      case $words[1] in\n{}      esac ;;\n  "
      "esac\n}}\n\n",
      name, specs, descriptions, cases);
}

}  // namespace

std::string zsh_completion(const CLI::App& app, const ProgramText& program) {
  std::string text = fmt::format(
      "#compdef {0}\n# zsh completion of {0}; made by `{0} --print-completion zsh`\n\n", program.name);
  for (const CommandRow& command : command_rows(app, program.name)) text += zsh_function(command, program);
  return text + fmt::format("{} \"$@\"\n", function_name(program.name));
}

}  // namespace heel::commandline
