// Completion for bash, in bash alone: the package bash-completion only loads it.
#include <fmt/format.h>

#include "commandline/completion.h"
#include "commandline/option_rows.h"
#include "commandline/program_text.h"

namespace heel::commandline {
namespace {

constexpr const char* kBashFiles = R"(
_FUNCTION_files() {  # [EXTENSION]
  compopt -o filenames
  if [[ -n $1 ]]; then
    mapfile -t COMPREPLY < <(compgen -f -X "!*.$1" -- "$current"; compgen -d -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}
)";

constexpr const char* kBashBegin = R"(
_FUNCTION() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]} command=PROGRAM word
  COMPREPLY=()
  if [[ $current == = ]]; then
    current=
  elif [[ $previous == = ]]; then
    previous=${COMP_WORDS[COMP_CWORD-2]}
  fi
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case "$command $word" in
COMMANDS    esac
  done
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// What fills COMPREPLY for a value of this row; empty: nothing is known of it.
std::string bash_action(const OptionRow& row, const ProgramText& program) {
  if (!row.choices.empty())
    return fmt::format("mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$current\")", joined(row.choices));
  if (const auto values = program.values.find(row.value); values != program.values.end())
    return fmt::format("compopt -o nospace; mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$current\")",
                       joined(values->second));
  std::string extension;
  switch (completes(row.value, &extension)) {
    case Completes::Files:
      return function_name(program.name) + "_files" + (extension.empty() ? "" : " " + extension);
    case Completes::Folders:
      return "compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- \"$current\")";
    case Completes::Nothing:
      break;
  }
  return "";
}

}  // namespace

std::string bash_completion(const CLI::App& app, const ProgramText& program) {
  std::string commands, values, names, arguments;
  for (const CommandRow& command : command_rows(app, program.name)) {
    if (command.app != &app) commands += fmt::format("      \"{0}\") command=\"{0}\" ;;\n", command.name);
    std::string all, below;
    for (const CLI::App* one : command.app->get_subcommands([](const CLI::App*) { return true; }))
      below += (below.empty() ? "" : " ") + one->get_name();
    for (const OptionRow& row : option_rows(*command.app)) {
      const std::string action = bash_action(row, program);
      if (row.names.empty() && !action.empty())
        arguments += fmt::format("    \"{}\") {} ;;\n", command.name, action);
      std::string pattern;
      for (const std::string& name : row.names) {
        all += (all.empty() ? "" : " ") + name;
        pattern += fmt::format("{}\"{} {}\"", pattern.empty() ? "" : " | ", command.name, name);
      }
      if (!row.names.empty() && !row.value.empty())
        values += fmt::format("    {}) {}; return ;;\n", pattern, action.empty() ? ":" : action);
    }
    names += fmt::format("      \"{}\") word=\"{}\" ;;\n", command.name, all);
    if (!below.empty())
      arguments += fmt::format("    \"{}\") mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$current\") ;;\n",
                               command.name, below);
  }
  std::string text =
      fmt::format("# bash completion of {0}; made by `{0} --print-completion bash`\n", program.name);
  text += kBashFiles + replaced(replaced(kBashBegin, "COMMANDS", commands), "PROGRAM", program.name);
  text += fmt::format("  case \"$command $previous\" in\n{}  esac\n", values);
  text += fmt::format("  if [[ $current == -* ]]; then\n    case $command in\n{}    esac\n", names);
  text += "    mapfile -t COMPREPLY < <(compgen -W \"$word\" -- \"$current\")\n    return\n  fi\n";
  text +=
      fmt::format("  case $command in\n{}  esac\n}}\ncomplete -F _FUNCTION {}\n", arguments, program.name);
  return replaced(text, "_FUNCTION", function_name(program.name));
}

}  // namespace heel::commandline
