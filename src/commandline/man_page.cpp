// The source of man pages: macros of man(7).
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "commandline/option_rows.h"
#include "commandline/program_text.h"
#include "commandline/roff.h"

namespace heel::commandline {
namespace {

std::string value_text(const OptionRow& row) {
  if (row.choices.empty()) return "\\fI" + roff_text(row.value) + "\\fR";
  std::string text;
  for (const std::string& choice : row.choices)
    text += (text.empty() ? "" : "|") + ("\\fB" + roff_text(choice) + "\\fR");
  return text;
}

/// "-o, --output OUT.kpd", or the name of an argument.
std::string heading(const OptionRow& row) {
  if (row.names.empty())
    return "\\fI" + roff_text(row.value.empty() || row.value == "TEXT" ? row.argument : row.value) + "\\fR" +
           (row.repeats ? "..." : "");
  std::string text;
  for (const std::string& name : row.names)
    text += (text.empty() ? "" : ", ") + ("\\fB" + roff_text(name) + "\\fR");
  if (!row.value.empty())
    text += " " + value_text(row) + (row.repeats && !row.value.ends_with("...") ? "..." : "");
  return text;
}

/// What the table says beside the description.
std::string facts(const OptionRow& row) {
  std::string text;
  const auto add = [&](const std::string& fact) { text += (text.empty() ? "" : "; ") + fact; };
  if (row.required) add("needed");
  if (!row.range.empty()) add(row.range);
  if (!row.default_text.empty()) add("default " + row.default_text);
  if (!row.environment.empty()) add("variable " + row.environment);
  return text.empty() ? "" : "(" + text + ")";
}

std::string options_text(const CLI::App& app) {
  std::string text;
  for (const OptionRow& row : option_rows(app)) {
    text += fmt::format(".TP\n{}\n{}", heading(row), roff_paragraph(row.description));
    if (const std::string more = facts(row); !more.empty()) text += roff_paragraph(more);
  }
  return text;
}

std::string examples_text(const std::vector<Example>& examples) {
  std::string text;
  for (const Example& example : examples)
    text += fmt::format(".TP\n.B {}\n{}", roff_text(example.line), roff_paragraph(example.does));
  return text;
}

std::string synopsis(const CLI::App& app, const std::string& name) {
  std::string text = fmt::format(".B {}\n[\\fIOPTIONS\\fR]", roff_text(name));
  if (!app.get_subcommands([](const CLI::App*) { return true; }).empty()) text += " \\fICOMMAND\\fR ...";
  for (const OptionRow& row : option_rows(app)) {
    if (!row.names.empty() && !row.required) continue;
    const std::string one =
        row.names.empty() ? heading(row) : "\\fB" + roff_text(row.names.back()) + "\\fR " + value_text(row);
    text += row.required ? " " + one : " [" + one + "]";
  }
  return text + "\n";
}

std::string statuses_text(const std::vector<ExitStatus>& statuses) {
  std::string text;
  for (const ExitStatus& status : statuses)
    text += fmt::format(".TP\n.B {}\n{}", status.status, roff_paragraph(status.meaning));
  return text;
}

std::string pairs_text(const char* title, const std::vector<std::pair<std::string, std::string>>& pairs) {
  if (pairs.empty()) return "";
  std::string text = fmt::format(".SH {}\n", title);
  for (const auto& [name, what] : pairs)
    text += fmt::format(".TP\n.B {}\n{}", roff_text(name), roff_paragraph(what));
  return text;
}

/// One section for each command, with all that its help says.
std::string commands_text(const CLI::App& app, const ProgramText& program) {
  std::string text;
  for (const CommandRow& row : command_rows(app, program.name)) {
    if (row.app == &app) continue;
    text += fmt::format(".SS {}\n{}.PP\n{}{}", roff_text(row.name), synopsis(*row.app, row.name),
                        roff_paragraph(row.app->get_description()), options_text(*row.app));
    const auto found = program.commands.find(row.name.substr(program.name.size() + 1));
    if (found == program.commands.end()) continue;
    if (!found->second.examples.empty()) text += ".PP\nExamples:\n" + examples_text(found->second.examples);
    if (!found->second.exit_statuses.empty())
      text += ".PP\nExit status:\n" + statuses_text(found->second.exit_statuses);
  }
  return text.empty() ? "" : ".SH COMMANDS\n" + text;
}

}  // namespace

std::string man_page(const CLI::App& app, const ProgramText& program) {
  std::string text = roff_title(program.name, program.section, "heel " HEEL_VERSION);
  text += fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}", roff_text(program.name),
                      roff_text(program.summary), synopsis(app, program.name));
  text += fmt::format(".SH DESCRIPTION\n{}.SH OPTIONS\n{}{}", roff_paragraph(program.description),
                      options_text(app), commands_text(app, program));
  text += ".SH EXIT STATUS\n" + statuses_text(program.exit_statuses);
  if (const auto own = program.commands.find(""); own != program.commands.end())
    text += ".SH EXAMPLES\n" + examples_text(own->second.examples);
  text += pairs_text("ENVIRONMENT", program.environment) + pairs_text("FILES", program.files);
  text += ".SH SEE ALSO\n";
  for (std::size_t i = 0; i < program.see_also.size(); ++i) {
    const std::string& page = program.see_also[i];
    const std::size_t section = page.find('(');
    text += fmt::format(".BR {} {}{}\n", roff_text(page.substr(0, section)), page.substr(section),
                        i + 1 < program.see_also.size() ? "," : "");
  }
  return text;
}

}  // namespace heel::commandline
