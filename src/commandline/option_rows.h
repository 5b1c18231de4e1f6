// The options and arguments of a command, as the man page and the completion of shells show them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace heel::commandline {

struct OptionRow {
  std::vector<std::string> names;  ///< "-o", "--output"; empty: an argument without a name
  std::string argument;            ///< the name of an argument without one
  std::string value;               ///< the kind of its value: "T.heel", "N"; empty: a flag
  std::vector<std::string> choices;
  std::string range;
  std::string default_text;
  std::string environment;
  std::string description;
  bool required = false;
  bool repeats = false;
};

/// In the order of the help: arguments first.
std::vector<OptionRow> option_rows(const CLI::App& app);

/// Every command that does work or has some below it, with its whole name: "heel bench vision"; the program
/// itself first.
struct CommandRow {
  std::string name;
  const CLI::App* app = nullptr;
};
std::vector<CommandRow> command_rows(const CLI::App& app, const std::string& name);

/// Up to the first full stop or semicolon, in one line.
std::string first_sentence(std::string_view text);
std::string in_one_line(std::string_view text);

enum class Completes { Nothing, Files, Folders };
/// What stands for a value of this kind; `*extension`: how the names of such files end, where that is known.
Completes completes(const std::string& value, std::string* extension);

}  // namespace heel::commandline
