// What a program says about itself beside its table of options: --help, the man page and the completion of
// shells are made from both.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace heel::commandline {

struct Example {
  std::string line;  ///< as it is typed
  std::string does;
};

struct ExitStatus {
  int status = 0;
  std::string meaning;
};

struct CommandText {
  std::vector<Example> examples;
  std::vector<ExitStatus> exit_statuses;  ///< of this command, where they say more than those of the program
};

struct ProgramText {
  std::string name;
  int section = 1;  ///< of the manual
  std::string summary;
  std::string description;
  std::vector<ExitStatus> exit_statuses;
  std::map<std::string, CommandText> commands;  ///< "bench vision"; "": the program itself
  std::vector<std::pair<std::string, std::string>> environment;
  std::vector<std::pair<std::string, std::string>> files;
  std::vector<std::string> see_also;                         ///< "heeld(8)"
  std::map<std::string, std::vector<std::string>> values{};  ///< of arguments, by the name of their type
};

/// Adds --version, --print-man and --print-completion to a program that has all its options and commands, and
/// ends the help of each command with its examples and exit statuses. `text` must live as long as `app`.
void add_program_text(CLI::App& app, const ProgramText& text);

/// The source of the man page, for man(7).
std::string man_page(const CLI::App& app, const ProgramText& text);
/// Scripts that complete commands, options and values in these shells.
std::string bash_completion(const CLI::App& app, const ProgramText& text);
std::string zsh_completion(const CLI::App& app, const ProgramText& text);

}  // namespace heel::commandline
