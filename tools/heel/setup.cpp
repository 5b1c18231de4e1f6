// heel setup: from nothing to a robot that is ready to follow, step by step.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>

#include "commands.h"
#include "heel/error.h"
#include "setup_steps.h"
#include "shell_word.h"

namespace heel::cli {
namespace {

constexpr double kFirstWalk = 0.25;  // of gate.v_max_m_s

struct SetupStep {
  const char* name;
  PreflightStep (*run)(Setup& setup);
  const char* does;
};

constexpr SetupStep kSetupSteps[] = {
    {"camera", set_up_camera, "chosen, its picture measured and upright"},
    {"calibration", set_up_calibration, "from a board that you move before the camera, or by a file"},
    {"robot", set_up_robot, "found, its battery and sonars heard; it stands still"},
    {"wheels", set_up_wheels, "on blocks, with your consent: they turn the right way"},
    {"shirt", set_up_shirt, "taught from the person who stands there"},
    {"check", set_up_check, "all of it measured once more, as heel preflight does"},
};

/// The steps that are still to be done, as options.
std::string options_from(const SetupStep& first, const SetupOptions& options) {
  std::string text;
  bool reached = false;
  for (const SetupStep& step : kSetupSteps) {
    reached = reached || &step == &first;
    const bool wanted = options.steps.empty() || options.again(step.name);
    if (reached && wanted) text += fmt::format(" --step {}", step.name);
  }
  return text;
}

void say_how_to_go_on(Setup& setup, const SetupStep& from) {
  setup.dialogue.say(fmt::format("What was done is kept in {}. Go on with:\n  heel setup --config {}{}",
                                 setup.file.path(), shell_word(setup.file.path()),
                                 options_from(from, setup.options)));
}

void say_what_is_next(Setup& setup) {
  const double v_m_s = kFirstWalk * setup.file.config().gate.v_max_m_s;
  const bool of_service = setup.file.path() == "/etc/heel/heel.toml";
  setup.dialogue.say(fmt::format(
      "ready. First walk, on blocks, then at a quarter of the speed, a hand at STOP (docs/first-walk.md):\n"
      "  {}\n"
      "  heel set gate.v_max_m_s={:.2g}    # until heeld is restarted\n"
      "  heel start",
      of_service ? "systemctl enable --now heeld" : "heeld --config " + shell_word(setup.file.path()),
      v_m_s));
}

PreflightStep run_setup_step(Setup& setup, const SetupStep& step) {
  setup.dialogue.say(fmt::format("\n{} of {}  {}: {}", 1 + &step - kSetupSteps, std::size(kSetupSteps),
                                 step.name, step.does));
  const PreflightStep done = step.run(setup);
  if (g_preflight_interrupted) throw SetupInterrupted();
  if (setup.options.json)
    std::cout << json_of(done).dump() << '\n' << std::flush;
  else
    std::cout << text_of(done) << std::flush;
  return done;
}

enum class AfterFailure { Again, Next, Stop };

AfterFailure ask_after_failure(Setup& setup) {
  AfterFailure answer = AfterFailure::Stop;
  try {
    const std::string usual = setup.options.usual_answers ? "stop" : "again";
    setup.dialogue.ask_until(
        "Try it again, go on with the next step, or stop?", usual, "", [&](const std::string& word) {
          if (word == "again") answer = AfterFailure::Again;
          if (word == "next") answer = AfterFailure::Next;
          return word == "again" || word == "next" || word == "stop" ? "" : "again, next or stop";
        });
  } catch (const Error&) {
    answer = AfterFailure::Stop;  // nobody is there
  }
  return answer;
}

/// Whether every step that was wanted has passed, or was left out by the person.
bool run_steps(Setup& setup) {
  bool all_passed = true;
  for (const SetupStep& step : kSetupSteps) {
    if (!setup.options.steps.empty() && !setup.options.again(step.name)) continue;
    try {
      AfterFailure next = AfterFailure::Again;
      PreflightStep done = run_setup_step(setup, step);
      while (done.verdict == StepVerdict::Fail && (next = ask_after_failure(setup)) == AfterFailure::Again)
        done = run_setup_step(setup, step);
      if (done.verdict != StepVerdict::Fail) continue;
      all_passed = false;
      if (next == AfterFailure::Next) continue;
    } catch (const SetupInterrupted&) {
      setup.dialogue.say("\nstopped");
    } catch (const Error&) {
      say_how_to_go_on(setup, step);
      throw;
    }
    say_how_to_go_on(setup, step);
    return false;
  }
  return all_passed;
}

void run_setup(const SetupOptions& options) {
  SetupFile file(options.config_file);
  note_interrupts();
  // With --json standard output is for programs alone.
  Dialogue dialogue(options.usual_answers, options.json ? std::cerr : std::cout);
  Setup setup{options, file, dialogue};
  const bool ready = run_steps(setup);
  if (options.json)
    std::cout << nlohmann::ordered_json{{"ready", ready}, {"config", file.path()}}.dump() << '\n';
  if (!ready) throw CLI::RuntimeError(kExitNo);
  if (options.steps.empty() || options.again("check")) say_what_is_next(setup);
}

void add_question_options(CLI::App& command, SetupOptions& options) {
  command.add_option("--camera", options.camera, "camera: v4l2:PATH, libcamera:ID, file:PATH, sim:NAME")
      ->type_name("SPEC");
  add_turn_options(command, options.turn);
  command.add_option("--camera-info", options.camera_info, "calibration: the camera file that there is")
      ->type_name("CAM.yaml");
  add_board_options(command, options.board, /*required=*/false);
  command.add_option("--robot", options.robot, "robot: serial:PATH@BAUD, pty:PATH@BAUD or tcp:HOST:PORT")
      ->type_name("ADDRESS");
  command.add_flag("--wheels-on-blocks", options.wheels_on_blocks,
                   "wheels: they are off the floor and may turn");
  CLI::Option* distance =
      command.add_option("--distance", options.distance_m, "shirt: from the camera to the back, metres")
          ->type_name("M")
          ->check(metres_from(0.3, 10.0));
  command
      .add_flag("--drive-back", options.drive_back,
                "shirt: in place of --distance the robot measures it, and drives half a metre back for it")
      ->excludes(distance);
  command.add_option("--height", options.height_m, "shirt: of the person, metres, to propose the outline")
      ->type_name("M")
      ->check(metres_from(0.8, 2.3));
  command.add_option("--roi", options.roi, "shirt: the outline, in place of the one proposed")
      ->expected(1, 4)
      ->type_name("X,Y,W,H");
  command.add_option("--countdown", options.countdown_s, "shirt: before the pictures are taken, seconds")
      ->type_name("S")
      ->check(number_from(0.0, 600.0))
      ->capture_default_str();
  command
      .add_option("--reach-time", options.reach_time_s,
                  "shirt: longest time for measuring how far it is found, seconds; 0: not measured")
      ->type_name("S")
      ->check(number_from(0.0, 3600.0))
      ->capture_default_str();
}

}  // namespace

bool SetupOptions::again(const std::string& step) const {
  return std::ranges::find(steps, step) != steps.end();
}

double metres_in(const std::string& answer, double least, double most) {
  double metres = 0.0;
  const char* const end = answer.data() + answer.size();
  const auto [used, error] = std::from_chars(answer.data(), end, metres);
  return error == std::errc{} && used == end && metres >= least && metres <= most ? metres : 0.0;
}

PreflightStep set_up_check(Setup& setup) {
  PreflightStep all{.name = "check"};
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  std::string passed, failed;
  for (const NamedStep& named : preflight_steps()) {
    if (named.check == check_wheels) continue;
    const PreflightStep step = named.check(setup.file.config());
    if (g_preflight_interrupted) throw SetupInterrupted();
    std::string text = text_of(step);
    text.pop_back();  // the end of its line
    setup.dialogue.say(text);
    std::string& names = step.verdict == StepVerdict::Pass ? passed : failed;
    names += (names.empty() ? "" : ", ") + step.name;
    steps.push_back(json_of(step));
  }
  all.values = {{"steps", steps}};
  if (failed.empty()) return all.pass("passed: " + passed);
  return all.fail("failed: " + failed, "heel setup --step NAME does a step again");
}

void add_setup_command(CLI::App& app) {
  auto options = std::make_shared<SetupOptions>();
  std::vector<std::string> names;
  std::string help = "only this step; may be repeated:";
  for (const SetupStep& step : kSetupSteps) {
    names.emplace_back(step.name);
    help += fmt::format("\n  {}: {}", step.name, step.does);
  }
  CLI::App* command = app.add_subcommand(
      "setup",
      "Sets a robot up by questions, from nothing to the first walk: each step ends in a measurement, and\n"
      "what it has found is written into the configuration file. Ctrl-C ends it; what was done is kept.\n"
      "Camera and robot are used directly: stop heeld first. Nothing moves without consent.");
  command
      ->add_option("--config", options->config_file,
                   "the daemon's configuration file; made where it is missing")
      ->required()
      ->type_name("FILE");
  command->add_option("--step", options->steps, help)->check(CLI::IsMember(names))->type_name("STEP");
  command->add_flag("--yes", options->usual_answers,
                    "the usual answer to each question; never to what would move the robot");
  add_question_options(*command, *options);
  command->add_flag("--json", options->json,
                    "an object a line for each step, and a last one; questions on standard error");
  command->callback([options] { run_setup(*options); });
}

}  // namespace heel::cli
