#include "evaluation/reports/plots.h"

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "evaluation/reports/run_program.h"
#include "heel/error.h"

namespace heel::evaluation {
namespace {

namespace fs = std::filesystem;

constexpr int kNoMatplotlib = 3;  ///< exit status of `plots`
constexpr const char* kNotInstalled =
    "no figures: matplotlib for Python 3 is missing (install the Debian package python3-matplotlib)";

fs::path plots_program() {
  if (const char* given = std::getenv("HEEL_PLOTS"); given != nullptr && *given != '\0') return given;
  return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share/heel/plots/plots";
}

/// Its last line, without the program's name.
std::string last_line_of(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  text = text.substr(text.rfind('\n') + 1);
  const std::string name = "plots: ";
  return text.starts_with(name) ? text.substr(name.size()) : text;
}

}  // namespace

std::string draw_figures(const std::vector<std::string>& arguments) {
  const fs::path program = plots_program();
  if (!fs::exists(program))
    return "no figures: " + program.string() +
           ": no such program (expected with heel; HEEL_PLOTS names another)";
  std::vector<std::string> command{program.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const ProgramEnd end = run_program(command);
  if (end.start_error == ENOENT) return kNotInstalled;  // the interpreter in its first line
  if (end.start_error != 0)
    throw Error(program.string() + ": cannot start: " + std::generic_category().message(end.start_error));
  if (end.status == kNoMatplotlib) return kNotInstalled;
  if (end.status == 0) return {};
  const std::string complaint = last_line_of(end.complaints);
  throw Error(complaint.empty() ? program.string() + ": ended with status " + std::to_string(end.status)
                                : complaint);
}

}  // namespace heel::evaluation
