// The command line of heeld.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "commandline/config_man_page.h"
#include "commandline/program_text.h"
#include "config/config_load.h"
#include "config/config_text.h"
#include "control/state_manual.h"
#include "daemon/check.h"
#include "daemon/daemon.h"
#include "daemon/thread_table.h"

namespace {

// EX_CONFIG of sysexits(3). systemd does not restart the service on it: a person must correct the
// configuration.
constexpr int kExitConfiguration = 78;

// EX_USAGE of sysexits(3): the command line. systemd does not restart the service on it either.
constexpr int kExitUsage = 64;

struct Options {
  std::string config;
  bool check = false;
  bool json = false;
  bool print_default_config = false;
  bool print_config_manual = false;
  bool print_state_manual = false;
  bool print_threads = false;
  bool print_config_man = false;
};

heel::commandline::ProgramText manual_text() {
  heel::commandline::ProgramText text;
  text.name = "heeld";
  text.section = 8;
  text.summary = "makes a Pioneer P3-AT follow a person by the back of their shirt";
  text.description =
      "The daemon: it reads the camera, finds the taught shirt, and drives the robot. The robot stands still "
      "until "
      "`heel start`. SIGTERM and SIGINT stop the robot and end the daemon; SIGHUP reads the configuration "
      "file "
      "again. It runs as the service heeld of systemd, or by itself.";
  text.exit_statuses = {
      {0, "done, or stopped by a signal"},
      {1, "an error while running"},
      {kExitUsage, "the command line cannot be used"},
      {kExitConfiguration, "the configuration or a file that it names cannot be used, or none is given"}};
  text.commands[""] = {{{"heeld --config /etc/heel/heel.toml --check", "every value and where it comes from"},
                        {"heeld --config heel.toml --check --json | jq -r .errors[]", "for scripts"},
                        {"heeld --config heel.toml", "runs until SIGINT or SIGTERM"},
                        {"heeld --print-default-config > heel.toml", "a file to begin with"}},
                       {}};
  text.files = {{"/etc/heel/heel.toml", "The configuration of the service, heel.toml(5)."},
                {"/run/heel/control.sock", "The socket of the operators, for heel(1)."},
                {"/var/lib/heel", "The recordings of the service."}};
  text.see_also = {"heel(1)", "heel-sim(1)", "heel.toml(5)", "systemctl(1)"};
  return text;
}

/// A command line that cannot be used, in one line on standard error.
int refuse(const std::string& what) {
  std::fprintf(stderr, "heeld: %s (see heeld --help)\n", what.c_str());
  return kExitUsage;
}

/// The first argument that no option takes.
int refuse_unexpected(const std::string& argument) {
  if (argument.starts_with('-')) return refuse(argument + ": unknown option");
  return refuse("'" + argument + "': not an option (expected --config FILE)");
}

int run(const Options& options) {
  if (options.print_default_config) {
    std::fputs(heel::default_config_text().c_str(), stdout);
    return 0;
  }
  if (options.print_config_manual) {
    std::fputs(heel::config_manual_text().c_str(), stdout);
    return 0;
  }
  if (options.print_state_manual) {
    std::fputs(heel::state_manual_text().c_str(), stdout);
    return 0;
  }
  if (options.print_threads) {
    std::fputs(heel::thread_table_text({}).c_str(), stdout);
    return 0;
  }
  if (options.print_config_man) {
    std::fputs(heel::commandline::config_man_page().c_str(), stdout);
    return 0;
  }
  if (options.check && options.json) {
    const heel::CheckAnswer answer = heel::check_configuration_as_json(options.config);
    std::printf("%s\n", answer.json.c_str());
    return answer.valid ? 0 : kExitConfiguration;
  }
  if (options.check) {
    heel::check_configuration(options.config);
    return 0;
  }
  return heel::run_daemon(options.config);
}

int run(int argc, char** argv) {
  const auto not_empty = [](const std::string& file) -> std::string {
    return file.empty() ? "an empty name (expected a file; is a variable of the shell not set?)" : "";
  };
  Options options;
  CLI::App app;
  auto* config =
      app.add_option("--config", options.config, "Configuration file (TOML); see docs/configuration.md")
          ->type_name("FILE")
          ->check(not_empty);
  auto* check = app.add_flag(
      "--check", options.check,
      "Check the configuration and the files it refers to, print every value with its origin, and exit");
  check->needs(config);
  app.add_flag("--json", options.json, "With --check: one JSON object, also of an invalid configuration")
      ->needs(check);
  auto* print = app.add_flag("--print-default-config", options.print_default_config,
                             "Print a configuration file with every key at its default value, and exit");
  auto* manual = app.add_flag("--print-config-manual", options.print_config_manual,
                              "Print the manual of all keys (docs/configuration.md), and exit");
  auto* states = app.add_flag("--print-state-manual", options.print_state_manual,
                              "Print the tables of the supervisor (in docs/safety.md), and exit");
  auto* threads = app.add_flag("--print-threads", options.print_threads,
                               "Print the table of threads (in docs/real-time.md), and exit");
  auto* config_man = app.add_flag("--print-config-man", options.print_config_man,
                                  "Print the man page of the configuration file, and exit");
  const heel::commandline::ProgramText text = manual_text();
  heel::commandline::add_program_text(app, text);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ExtrasError& error) {
    return refuse_unexpected(app.remaining().front());
  } catch (const CLI::ParseError& error) {
    return refuse(error.what());
  }
  if (config->count() + print->count() + manual->count() + states->count() + threads->count() +
          config_man->count() ==
      0) {
    std::fputs(
        "heeld: no configuration; expected --config FILE (heeld --print-default-config prints an example)\n",
        stderr);
    return kExitConfiguration;
  }

  return run(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const heel::ConfigError& error) {
    std::fflush(stdout);  // what was printed before the error stays before it
    for (const auto& line : error.lines()) std::fprintf(stderr, "%s\n", line.c_str());
    return kExitConfiguration;
  } catch (const heel::Error& error) {
    std::fflush(stdout);
    std::fprintf(stderr, "%s\n", error.what());
    return kExitConfiguration;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heeld: %s\n", error.what());
    return 1;
  }
}
