// heel watch: the status of the running heeld, at each change and once a period.
#include <chrono>
#include <iostream>

#include "commands.h"
#include "operator_client.h"
#include "status_text.h"

namespace heel::cli {
namespace {

constexpr double kAlivePeriod_s = 0.5;
constexpr double kLate_s = 5.0;  // so much after the period: heeld does not answer

struct WatchOptions : OperatorOptions {
  bool json = false;
  bool alive = false;
  double period_s = 1.0;
};

void print_event(const Json& line, bool json) {
  std::cout << (json ? line.dump() : watch_text(line)) << std::endl;
}

/// Until it is interrupted, or heeld ends.
void run_watch(const WatchOptions& options) {
  using SteadyClock = std::chrono::steady_clock;
  const std::chrono::duration<double> longest(options.period_s + kLate_s), alive_period(kAlivePeriod_s);
  OperatorClient client(options.socket, "watch");
  print_event(client.ask({{"do", "watch"}, {"period_s", options.period_s}}, longest.count()), options.json);
  SteadyClock::time_point last_event = SteadyClock::now(), last_alive;
  while (std::cout.good()) {
    if (options.alive && SteadyClock::now() - last_alive >= alive_period) {
      last_alive = SteadyClock::now();
      client.send({{"do", "alive"}});
    }
    const Json line = client.next(kAlivePeriod_s);
    if (line.contains("event")) {  // others answer `alive`
      print_event(line, options.json);
      last_event = SteadyClock::now();
    } else if (line.contains("error")) {  // as before heeld closes the connection
      std::cerr << "heel watch: " << line.value("error", std::string()) << std::endl;
    } else if (SteadyClock::now() - last_event > longest) {
      client.fail(options.socket + ": heeld does not answer any more");
    }
  }
}

}  // namespace

void add_watch_command(CLI::App& app) {
  auto options = std::make_shared<WatchOptions>();
  CLI::App* command = app.add_subcommand(
      "watch", "Shows a line of status at each change, and once a period, until it is interrupted");
  command->add_flag("--json", options->json, "each as one JSON object (docs/operator.md)");
  command->add_option("--period", options->period_s, "longest time between two lines, seconds")
      ->check(number_from(0.1, 60.0))
      ->capture_default_str();
  command->add_flag("--alive", options->alive,
                    "say twice a second that the operator is there (supervisor.operator_timeout_s)");
  add_operator_options(*command, *options);
  command->callback([options] { run_watch(*options); });
}

}  // namespace heel::cli
