// heel, the operator's command: what all subcommands share (help, version, errors, exit status).
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <opencv2/core/utility.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <string>

#include "commands.h"
#include "heel/error.h"
#include "manual.h"

namespace {

using namespace heel::cli;

void add_commands(CLI::App& app) {
  add_calibrate_command(app);
  add_teach_command(app);
  add_pose_command(app);
  add_preflight_command(app);
  add_setup_command(app);
  add_card_command(app);
  add_features_command(app);
  add_simulate_command(app);
  add_tune_command(app);
  add_merge_command(app);
  add_experiment_command(app);
  add_fit_command(app);
  add_report_command(app);
  add_mark_command(app);
  add_replay_command(app);
  add_export_command(app);
  add_latency_command(app);
  add_bundle_command(app);
  add_bench_command(app);
  add_status_command(app);
  add_start_command(app);
  add_stop_command(app);
  add_estop_command(app);
  add_reset_command(app);
  add_set_command(app);
  add_save_command(app);
  add_watch_command(app);
}

/// Refuses the empty value that an unset variable of a shell gives, of every option and argument.
void refuse_empty_values(CLI::App& app) {
  const auto check = [](const std::string& value) -> std::string {
    return value.empty() ? "an empty name (expected a file or a value; is a variable of the shell not set?)"
                         : "";
  };
  for (CLI::Option* option : app.get_options())
    if (option->get_items_expected_max() > 0) option->check(check);
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_values(*command);
}

/// One thread, so that results are the same to the bit on any number of cores. No messages of OpenCV and
/// FFmpeg: an error is one line of ours.
void set_up_libraries() {
  cv::setNumThreads(1);
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", /*overwrite=*/0);
}

/// "heel teach" or "heel bench vision" when such a subcommand was being parsed or run, else "heel".
std::string command_name(const CLI::App& app) {
  const std::string& name = app.get_name();
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? name : name + " " + command_name(*chosen.front());
}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

/// False when standard output cannot be written: a full disk, or a pipe without a reader.
bool flush_output() {
  std::cout.flush();
  return std::cout.good() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

int print_error(const CLI::App& app, const std::string& text) {
  flush_output();  // output from before the error stays before it
  std::cerr << command_name(app) << ": " << one_line(text) << '\n';
  return kExitBadInput;
}

std::string command_list(const CLI::App& app) {
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  return names;
}

int run_command(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return EXIT_SUCCESS;
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::RuntimeError& answer) {
    return answer.get_exit_code();
  } catch (const CLI::ParseError& error) {
    if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
      return print_error(
          app, std::string("no command '") + argv[1] + "' (expected one of " + command_list(app) + ")");
    }
    return print_error(app, one_line(error.what()) + " (see " + command_name(app) + " --help)");
  } catch (const std::filesystem::filesystem_error& error) {
    return print_error(app, error.path1().string() + ": " + error.code().message() +
                                " (expected a file or folder that this user can use)");
  } catch (const std::exception& error) {
    return print_error(app, error.what());
  }
}

int run(int argc, char** argv) {
  CLI::App app;
  app.require_subcommand(1);
  add_commands(app);
  const heel::commandline::ProgramText manual = heel_manual();
  heel::commandline::add_program_text(app, manual);
  refuse_empty_values(app);

  const int status = run_command(app, argc, argv);
  if (!flush_output())
    return print_error(app, "standard output cannot be written (expected a disk with space, or a reader)");
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  set_up_libraries();
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heel: %s\n", error.what());
    return kExitBadInput;
  }
}
