#include "manual.h"

#include "commands.h"
#include "config/config_table.h"

namespace heel::cli {
namespace {

using commandline::CommandText;
using commandline::Example;
using commandline::ExitStatus;

const ExitStatus kDone{0, "done"};
const ExitStatus kBadInput{kExitBadInput, "bad usage or input"};
const ExitStatus kUnreachable{kExitUnreachable, "heeld cannot be reached"};

CommandText offline(std::vector<Example> examples, const std::string& no = "") {
  std::vector<ExitStatus> statuses{kDone};
  if (!no.empty()) statuses.push_back({kExitNo, no});
  statuses.push_back(kBadInput);
  return {std::move(examples), std::move(statuses)};
}

/// A command to the running heeld.
CommandText online(std::vector<Example> examples) {
  return {std::move(examples), {kDone, {kExitNo, "refused, the reason is printed"}, kBadInput, kUnreachable}};
}

std::map<std::string, CommandText> files_and_pictures() {
  return {
      {"calibrate",
       offline(
           {{"heel calibrate board-*.png --board 9x6 --square 0.025 -o camera.yaml",
             "from photographs of a board of 10x7 squares of 25 mm"},
            {"heel calibrate views/ --board 4x11 --square 0.02 --pattern asymmetric-circles -o camera.yaml",
             "from a folder of photographs of a grid of circles"}})},
      {"teach", offline({{"heel teach --image person.png --roi 250,120,140,180 --distance 1.5 --camera-info "
                          "camera.yaml -o shirt.heel",
                          "from a photograph, taken 1.5 m behind the person"},
                         {"heel teach --camera v4l2:/dev/video0 --roi 250,120,140,180 --distance 1.5 "
                          "--camera-info camera.yaml -o shirt.heel",
                          "from the camera, now"},
                         {"heel teach --image person.png --roi 250,120,140,180 --card card.png --camera-info "
                          "camera.yaml -o shirt.heel",
                          "the distance from a second picture, with the printed card against the back"}},
                        "the shirt is refused, the reason is printed")},
      {"card", offline({{"heel card -o card.pdf", "to print on A4, at 100 %"},
                        {"heel card -o card.pdf --paper letter", "on Letter"}})},
      {"setup",
       offline({{"heel setup --config /etc/heel/heel.toml", "questions, from nothing to the first walk"},
                {"heel setup --config heel.toml --step shirt", "another shirt; all else stays"},
                {"heel setup --config heel.toml --camera v4l2:/dev/video0 --camera-info camera.yaml --robot "
                 "tcp:robot:8101 --distance 1.6 --yes",
                 "without questions; the wheels stand still"}},
               "a step failed, or was stopped; what was done is kept")},
      {"preflight",
       offline(
           {{"heel preflight --config /etc/heel/heel.toml", "all steps, the wheels stand still"},
            {"heel preflight --config heel.toml wheels --wheels-on-blocks", "do they turn the right way?"},
            {"heel preflight --config heel.toml camera person --json", "two steps, for programs"}},
           "a step failed")},
      {"pose",
       offline({{"heel pose --config /etc/heel/heel.toml walk.mp4", "a table, a row for each frame"},
                {"heel pose --template shirt.heel --camera-info camera.yaml walk.mp4 --json > poses.jsonl",
                 "one JSON object a line"},
                {"heel pose --config heel.toml --independent pictures/ --picture-dir drawn",
                 "pictures that do not follow each other, with the shirt's outline drawn"}})},
      {"features", offline({{"heel features wall.png -o wall.kpd --max 1000", "the 1000 strongest"},
                            {"heel features wall.png -o wall.txt --oriented", "as text, oriented"}})},
      {"export", offline({{"heel export run.mcap --csv -o csv", "CSV files into the folder csv"}})},
      {"bundle", offline({{"heel bundle", "the service's newest recording into heel-bundle.mcap"},
                          {"heel bundle run.mcap -o report.mcap --with-pictures", "with its pictures"}})},
      {"latency",
       offline({{"heel latency run.mcap", "a table of hops"},
                {"heel latency /var/lib/heel --picture latency.png", "of the newest recording, drawn"},
                {"heel latency --light --config heel.toml", "of the camera: it looks at this terminal"}})},
      {"replay",
       offline({{"heel replay run.mcap", "is everything the same to the bit?"},
                {"heel replay run.mcap --diff --plot out", "every quantity that differs, and a picture"},
                {"heel replay run.mcap --set control.gain_yaw_1_s=1.2",
                 "what heel would have done with this value"}},
               "they differ")},
  };
}

std::map<std::string, CommandText> simulation() {
  return {
      {"simulate",
       offline({{"heel simulate walk.toml", "one run, in detail"},
                {"heel simulate scenarios/ -o out", "all scenarios of a folder, a table and figures"},
                {"heel simulate walk.toml --error-model vision.toml --runs 200 --json",
                 "statistics over 200 seeds, without drawing pictures"}},
               "a limit is not met")},
      {"tune",
       offline({{"heel tune gait.toml walk.toml --error-model pictured.toml --config heel.toml -o heel.toml "
                 "--picture tune.png",
                 "better gains of the law, into the configuration, and a picture"},
                {"heel tune walk.toml --error-model pictured.toml --key control.gain_yaw_1_s --json",
                 "one key; nothing is written"}},
               "no better values found")},
      {"merge", offline({{"heel merge runs/*.json", "tables over the runs of many processes"},
                         {"heel merge runs/*.json --json > sweep.json", "for programs"}},
                        "a run has not met a limit")},
      {"experiment",
       offline({{"heel experiment errors fig4_yaw -o out", "two of the experiments"},
                {"heel experiment stills -o out --seed 7", "a test set of pictures with truth"}})},
      {"fit", offline({{"heel fit out --walk walk.toml -o vision.toml",
                        "a model of vision's errors, for `heel simulate --error-model`"}})},
      {"report", offline({{"heel report out/runs/walk", "of a run"},
                          {"heel report out --json", "of a folder of experiments"}},
                         "a limit is not met")},
      {"bench", offline({{"heel bench vision", "each stage of vision beside OpenCV"}})},
      {"bench vision",
       offline({{"heel bench vision", "on a simulated walk"},
                {"heel bench vision walk.mp4 --template shirt.heel --camera-info camera.yaml --json",
                 "on a video, as JSON"}})},
      {"bench control",
       offline({{"heel bench control --seconds 300", "five minutes idle, five under load"}})},
      {"bench daemon", offline({{"heel bench daemon --pictures jpeg", "with pictures recorded as JPEG"}})},
  };
}

std::map<std::string, CommandText> commands_to_heeld() {
  return {
      {"status", online({{"heel status", "what it does, and why"},
                         {"heel status --json | jq -r .state", "for scripts"}})},
      {"start", online({{"heel start", "the robot may move from now on"}})},
      {"stop", online({{"heel stop", "to rest within the limits"}})},
      {"estop", online({{"heel estop", "to rest at once"}})},
      {"reset", online({{"heel reset", "after an emergency stop"}})},
      {"set", online({{"heel set gate.v_max_m_s=0.3", "slower, from the next control tick on"}})},
      {"save", online({{"heel save", "keeps what was set"}})},
      {"watch", online({{"heel watch", "a view on the terminal, also over ssh"},
                        {"heel watch --json --period 1 | tee status.jsonl",
                         "a line at each change and each second"}})},
      {"mark", online({{"heel mark 'the person turned'", "into the recording, with the time"}})},
  };
}

std::vector<std::string> keys_to_set() {
  std::vector<std::string> keys;
  for (const ConfigKey& key : config_keys())
    if (key.can_be_set()) keys.push_back(key.full_name() + "=");
  return keys;
}

}  // namespace

commandline::ProgramText heel_manual() {
  commandline::ProgramText text;
  text.name = "heel";
  text.summary = "a Pioneer P3-AT follows one person by the back of the person's shirt";
  text.description =
      "The operator's command: it calibrates the camera, teaches the shirt, steers and watches the running "
      "heeld, and simulates, measures and replays runs.\n"
      "Results go to standard output, errors and notes to standard error. With `--json` standard output "
      "holds "
      "JSON and nothing else: one object, a list where several scenarios are simulated, and one object a "
      "line "
      "of `heel pose` and `heel watch`. Progress and colour are shown on a terminal only.";
  text.exit_statuses = {
      kDone,
      {kExitNo, "the answer is no: shirt or command refused, limit not met, recordings differ"},
      kBadInput,
      kUnreachable};
  text.commands = files_and_pictures();
  text.commands.merge(simulation());
  text.commands.merge(commands_to_heeld());
  text.commands[""] = {{{"heel status", "what the running heeld does, and why"},
                        {"heel pose --help", "options and examples of a command"}},
                       {}};
  text.environment = {
      {"HEEL_SOCKET", "The socket of heeld, in place of `--socket`."},
      {"HEEL_TEST_DATA", "The folder of real pictures, in place of `heel experiment --data`."},
      {"NO_COLOR", "Set: no colour on a terminal."}};
  text.files = {{"/run/heel/control.sock", "The socket of the running heeld."},
                {"/etc/heel/heel.toml", "The configuration of the service."},
                {"/var/lib/heel", "The recordings of the service."}};
  text.see_also = {"heeld(8)", "heel-sim(1)", "heel.toml(5)"};
  text.values = {{"KEY=VALUE", keys_to_set()}};
  return text;
}

}  // namespace heel::cli
