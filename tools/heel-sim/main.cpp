// heel-sim: a simulated P3-AT in real time, on a pty or a TCP port, for any client that speaks ARCOS; with a
// scenario also a walking person and the frames of the robot's camera.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>

#include "commandline/program_text.h"
#include "files/camera_info.h"
#include "live_simulation.h"
#include "manual.h"
#include "options.h"
#include "sim/live/reference_picture.h"
#include "sim/scene/sent_picture.h"

namespace {

using namespace heel;
using namespace heel::sim;

volatile std::sig_atomic_t g_stop = 0;
void on_signal(int) {
  g_stop = 1;
}

std::unique_ptr<Scenario> read_scenario_of(const CLI::App& app, const Options& options) {
  if (options.scenario_file.empty()) return nullptr;
  auto scenario = std::make_unique<Scenario>(read_scenario(options.scenario_file));
  if (app.count("--seed") > 0) scenario->seed = options.seed;
  return scenario;
}

/// The files that need no robot.
void write_files(const Options& options, const Scenario& scenario) {
  if (!options.camera_info_file.empty())
    write_camera_model(sent_camera(scenario.camera), options.camera_info_file);
  if (!options.reference_picture.empty())
    write_reference_picture(scenario, options.reference_picture, options.reference_distance_m);
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app;
  add_options(app, options);
  const commandline::ProgramText manual = heel_sim_manual();
  heel::commandline::add_program_text(app, manual);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help, --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "heel-sim: %s (see heel-sim --help)\n", error.what());
    return kExitUsage;
  }
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, on_signal);
  std::signal(SIGPIPE,
              SIG_IGN);  // when the reader of our output ends, the pty's symlink must still be removed
  check_options(options);
  const std::unique_ptr<Scenario> scenario = read_scenario_of(app, options);
  if (scenario) write_files(options, *scenario);
  if (options.robot.empty()) return 0;
  LiveSimulation simulation(options, scenario.get());
  simulation.run(g_stop);
  simulation.print_camera_counters();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "heel-sim: %s\n", error.what());
    return kExitInput;
  }
}
