// heel watch: the status of the running heeld. On a terminal a view that is drawn again and again, elsewhere
// a line at each change and once a period.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "commandline/progress.h"
#include "commands.h"
#include "operator_client.h"
#include "status_text.h"
#include "terminal.h"
#include "watch_screen.h"

namespace heel::cli {
namespace {

constexpr double kAlivePeriod_s = 0.5;
constexpr double kLate_s = 5.0;  // so much after the period: heeld does not answer

constexpr double kScreenPeriod_s = 0.2;
constexpr double kKeyWait_s = 0.04;  // between two looks at the keys

struct WatchOptions : OperatorOptions {
  bool lines = false;
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
  OperatorClient client(options, "watch");
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

/// What a line that is no status says: empty, or what became of an emergency stop.
std::string note_of(const Json& answer) {
  if (answer.contains("error")) return answer.value("error", std::string());
  return answer.contains("outcome")
             ? fmt::format("emergency stop: {}", answer.value("outcome", std::string()))
             : "";
}

/// Until `q`, a signal, or the end of heeld.
void run_watch_screen(const WatchOptions& options) {
  using SteadyClock = std::chrono::steady_clock;
  const auto seconds_since = [](SteadyClock::time_point then) {
    return std::chrono::duration<double>(SteadyClock::now() - then).count();
  };
  OperatorClient client(options, "watch");
  const double period_s = std::min(options.period_s, kScreenPeriod_s);
  Json status = client.ask({{"do", "watch"}, {"period_s", period_s}}, period_s + kLate_s);
  SteadyClock::time_point last_status = SteadyClock::now(), last_alive, last_note;
  Screen screen;
  WatchLook look;
  look.colour = commandline::colour_wanted(STDOUT_FILENO);
  while (!screen.ended()) {
    for (char key = screen.key(); key != 0; key = screen.key()) {
      if (key == 'q' || key == 'Q') return;
      if (key != ' ') continue;
      client.send({{"do", "estop"}});
      look.note = "emergency stop sent";
      last_note = SteadyClock::now();
    }
    if (options.alive && seconds_since(last_alive) >= kAlivePeriod_s) {
      last_alive = SteadyClock::now();
      client.send({{"do", "alive"}});
    }
    const Json line = client.next(kKeyWait_s);
    if (line.contains("event")) {
      status = line;
      last_status = SteadyClock::now();
    } else if (const std::string note = note_of(line); !note.empty()) {
      look.note = note;
      last_note = SteadyClock::now();
    }
    if (seconds_since(last_note) > kLate_s) look.note.clear();
    look.columns = screen.size().columns;
    look.news_age_s = seconds_since(last_status);
    screen.draw(watch_screen(status, look));
  }
}

}  // namespace

void add_watch_command(CLI::App& app) {
  auto options = std::make_shared<WatchOptions>();
  CLI::App* command = app.add_subcommand(
      "watch",
      "Shows state, reason, speed, person, battery and what was set, until `q`; the space bar is an "
      "emergency stop. "
      "Not on a terminal: a line at each change, and once a period, until it is interrupted");
  command->add_flag("--lines", options->lines, "lines on a terminal, too");
  command->add_option("--period", options->period_s, "longest time between two lines, seconds")
      ->check(number_from(0.1, 60.0))
      ->capture_default_str();
  command->add_flag("--alive", options->alive,
                    "say twice a second that the operator is there (supervisor.operator_timeout_s)");
  add_operator_options(*command, *options, "each line as one JSON object (docs/operator.md)");
  command->callback([options] {
    if (!options->json && !options->lines && is_screen())
      run_watch_screen(*options);
    else
      run_watch(*options);
  });
}

}  // namespace heel::cli
