#include "commandline/option_rows.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace heel::commandline {
namespace {

constexpr std::array kFileKinds{"FILE",      "INPUT",    "IMAGE", "IMAGES",
                                "RECORDING", "SCENARIO", "PATH",  "SOCKET"};

/// "INT:{1,2}:0…5" into its parts; a colon inside braces is no border.
std::vector<std::string> parts_of(const std::string& type) {
  std::vector<std::string> parts(1);
  int depth = 0;
  for (const char c : type) {
    depth += c == '{' ? 1 : c == '}' ? -1 : 0;
    if (c == ':' && depth == 0)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::vector<std::string> choices_of(const std::string& set) {
  std::vector<std::string> choices(1);
  for (const char c : std::string_view(set).substr(1, set.size() - 2)) {
    if (c == ',')
      choices.emplace_back();
    else
      choices.back() += c;
  }
  return choices;
}

OptionRow row_of(const CLI::Option& option) {
  OptionRow row;
  for (const std::string& name : option.get_snames()) row.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) row.names.push_back("--" + name);
  if (row.names.empty()) row.argument = option.get_name(/*positional=*/true);
  row.description = option.get_description();
  row.required = option.get_required();
  row.environment = option.get_envname();
  row.repeats = option.get_items_expected_max() > 1 &&
                option.get_items_expected_min() != option.get_items_expected_max();
  if (option.get_items_expected_max() == 0) return row;
  row.default_text = option.get_default_str();
  const std::vector<std::string> parts = parts_of(option.get_type_name());
  row.value = parts.front();
  for (std::size_t i = 1; i < parts.size(); ++i) {
    if (parts[i].starts_with('{') && parts[i].ends_with('}'))
      row.choices = choices_of(parts[i]);
    else
      row.range = parts[i];
  }
  return row;
}

}  // namespace

std::vector<OptionRow> option_rows(const CLI::App& app) {
  std::vector<OptionRow> rows;
  for (const CLI::Option* option : app.get_options()) rows.push_back(row_of(*option));
  std::stable_partition(rows.begin(), rows.end(), [](const OptionRow& row) { return row.names.empty(); });
  return rows;
}

std::vector<CommandRow> command_rows(const CLI::App& app, const std::string& name) {
  std::vector<CommandRow> rows{{name, &app}};
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    for (CommandRow& row : command_rows(*command, name + " " + command->get_name()))
      rows.push_back(std::move(row));
  return rows;
}

std::string in_one_line(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\n';
    if (!space || (!line.empty() && line.back() != ' ')) line += space ? ' ' : c;
  }
  while (line.ends_with(' ')) line.pop_back();
  return line;
}

std::string first_sentence(std::string_view text) {
  const std::string line = in_one_line(text);
  std::size_t end = std::min(line.find(". "), line.find("; "));
  if (end == std::string::npos && line.ends_with('.')) end = line.size() - 1;
  return line.substr(0, end);
}

Completes completes(const std::string& value, std::string* extension) {
  if (value == "DIR") return Completes::Folders;
  if (std::find(kFileKinds.begin(), kFileKinds.end(), value) != kFileKinds.end()) return Completes::Files;
  const std::size_t dot = value.find('.');
  if (dot == std::string::npos || dot + 1 == value.size() || value.ends_with("...")) {
    return value.starts_with("IMAGE") ? Completes::Files : Completes::Nothing;
  }
  *extension = value.substr(dot + 1);
  return Completes::Files;
}

}  // namespace heel::commandline
