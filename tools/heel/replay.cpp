// heel replay: the inputs of a recording through today's code.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "evaluation/reports/plots.h"
#include "files/csv_file.h"
#include "files/folder.h"
#include "heel/error.h"
#include "replay/control_replay.h"
#include "replay/vision_replay.h"

namespace heel::cli {
namespace {

using ReplayJson = nlohmann::ordered_json;

struct ReplayCommandOptions {
  std::string recording;
  std::vector<std::string> settings;
  bool diff = false;
  std::string plot;
  bool json = false;
};

/// "12 345 678"
std::string grouped(std::uint64_t number) {
  std::string text = fmt::format("{}", number);
  for (int place = static_cast<int>(text.size()) - 3; place > 0; place -= 3)
    text.insert(static_cast<std::size_t>(place), " ");
  return text;
}

ReplaySettings settings_of(const std::vector<std::string>& arguments) {
  ReplaySettings settings;
  for (const std::string& argument : arguments) {
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == argument.size())
      throw Error(fmt::format("--set {}: no KEY=VALUE (expected control.gain_yaw_1_s=1.2)", argument));
    settings.emplace_back(argument.substr(0, equals), argument.substr(equals + 1));
  }
  return settings;
}

/// replay.csv: the recorded commands beside the replayed ones.
class ReplayCsv {
 public:
  explicit ReplayCsv(const std::string& folder)
      : file_(folder + "/replay.csv",
              "t_s,recorded_v_m_s,replayed_v_m_s,recorded_yaw_rate_rad_s,replayed_yaw_rate_rad_s") {}
  void add(const TickRecord& recorded, const TickRecord& replayed) {
    if (!begun_) t_begin_ns_ = recorded.input.now_ns;
    begun_ = true;
    file_.number(seconds_from_ns(recorded.input.now_ns - t_begin_ns_), 4);
    file_.number(recorded.command.v_m_s, 6).number(replayed.command.v_m_s, 6);
    file_.number(recorded.command.yaw_rate_rad_s, 6).number(replayed.command.yaw_rate_rad_s, 6);
    file_.end_row();
  }
  void flush() { file_.flush(); }

 private:
  CsvFile file_;
  bool begun_ = false;
  TimeNs t_begin_ns_ = 0;
};

void print_tick(const char* what, const TickDifference& tick, TimeNs t_begin_ns) {
  std::cout << fmt::format("{}: tick {}, {:.3f} s after the first\n", what, grouped(tick.recorded.tick),
                           seconds_from_ns(tick.recorded.input.now_ns - t_begin_ns));
  for (const FieldDifference& field : tick.fields)
    std::cout << fmt::format("  {:<32} recorded {}, replayed {}\n", field.name, field.a, field.b);
}

void print_quantities(const ReplayResult& result) {
  std::cout << fmt::format("{:<34}{:>10}{:>12}  {}\n", "quantity", "ticks", "first tick",
                           "largest difference");
  for (const auto& [name, quantity] : result.quantities)
    std::cout << fmt::format("{:<34}{:>10}{:>12}  {}\n", name, grouped(quantity.ticks),
                             grouped(quantity.first_tick),
                             quantity.largest > 0.0 ? fmt::format("{:.6g}", quantity.largest) : "-");
}

void print_answer(const ReplayResult& result, bool asked_what_if) {
  if (!asked_what_if) {
    std::cout << fmt::format("{} of {} ticks the same ({:.1f} s)\n", grouped(result.same),
                             grouped(result.ticks), result.duration_s);
  } else if (result.first_command) {
    std::cout << fmt::format("the commands of {} ticks are the same ({:.1f} s); then they differ\n",
                             grouped(result.ticks - 1), result.duration_s);
  } else {
    std::cout << fmt::format("all {} commands are the same ({:.1f} s); {} ticks decided the same\n",
                             grouped(result.ticks), result.duration_s, grouped(result.same));
  }
}

void print_vision(const VisionReplayResult& vision) {
  if (vision.frames > 0)
    std::cout << fmt::format("{} of {} frames the same in vision\n", grouped(vision.same),
                             grouped(vision.frames));
  if (vision.first) {
    std::cout << fmt::format("first difference in vision: frame {}\n", vision.first->frame_sequence);
    for (const FieldDifference& field : vision.fields)
      std::cout << fmt::format("  {:<32} recorded {}, replayed {}\n", field.name, field.a, field.b);
  }
  if (!vision.ended.empty()) std::cout << vision.ended << '\n';
}

void print_result(const ReplayResult& result, const std::optional<VisionReplayResult>& vision, bool what_if,
                  bool diff, TimeNs t_begin_ns) {
  print_answer(result, what_if);
  const auto& shown = what_if ? result.first_command : result.first;
  if (shown) print_tick(what_if ? "first command that differs" : "first difference", *shown, t_begin_ns);
  if (diff && !result.quantities.empty()) print_quantities(result);
  if (!result.ended.empty()) std::cout << result.ended << '\n';
  if (vision) print_vision(*vision);
}

ReplayJson json_of(const std::vector<FieldDifference>& fields) {
  ReplayJson json = ReplayJson::array();
  for (const FieldDifference& field : fields)
    json.push_back({{"name", field.name}, {"recorded", field.a}, {"replayed", field.b}});
  return json;
}

ReplayJson json_of(const std::optional<TickDifference>& tick, TimeNs t_begin_ns) {
  if (!tick) return nullptr;
  return {{"tick", tick->recorded.tick},
          {"t_s", seconds_from_ns(tick->recorded.input.now_ns - t_begin_ns)},
          {"fields", json_of(tick->fields)}};
}

ReplayJson json_of(const ReplayResult& result, const std::optional<VisionReplayResult>& vision,
                   TimeNs t_begin_ns) {
  ReplayJson json{{"ticks", result.ticks},
                  {"same", result.same},
                  {"duration_s", result.duration_s},
                  {"first", json_of(result.first, t_begin_ns)},
                  {"first_command", json_of(result.first_command, t_begin_ns)},
                  {"quantities", ReplayJson::array()},
                  {"ended", result.ended},
                  {"vision", nullptr}};
  for (const auto& [name, quantity] : result.quantities)
    json["quantities"].push_back({{"name", name},
                                  {"ticks", quantity.ticks},
                                  {"first_tick", quantity.first_tick},
                                  {"largest", quantity.largest}});
  if (vision) json["vision"] = {{"frames", vision->frames}, {"same", vision->same}, {"ended", vision->ended}};
  if (vision && vision->first)
    json["vision"]["first"] = {{"frame", vision->first->frame_sequence}, {"fields", json_of(vision->fields)}};
  return json;
}

void run_replay(const ReplayCommandOptions& options) {
  const std::string file = recording_in(options.recording);
  ReplayOptions replay{settings_of(options.settings), !options.settings.empty(), {}};
  std::optional<ReplayCsv> csv;
  if (!options.plot.empty()) {
    make_folder(options.plot);
    csv.emplace(options.plot);
  }
  TimeNs t_begin_ns = 0;
  replay.on_tick = [&](const TickRecord& recorded, const TickRecord& replayed) {
    if (recorded.tick == 0) t_begin_ns = recorded.input.now_ns;
    if (csv) csv->add(recorded, replayed);
  };
  const ReplayResult result = replay_control(file, replay);
  const bool what_if = replay.until_command_differs;
  std::optional<VisionReplayResult> vision;
  if (!what_if) vision = replay_vision(file);
  if (options.json)
    std::cout << json_of(result, vision, t_begin_ns).dump(2) << '\n';
  else
    print_result(result, vision, what_if, options.diff, t_begin_ns);
  for (const std::string& problem : result.report.problems) std::cerr << "heel replay: " << problem << '\n';
  for (const std::string& name : result.report.other_version)
    std::cerr << "heel replay: " << name
              << ": in the recording or in this version of heel alone; it counts with its default\n";
  if (csv) {
    csv->flush();
    if (const std::string why_not = evaluation::draw_figures({options.plot}); !why_not.empty())
      std::cerr << "heel replay: " << why_not << '\n';
  }
  const bool same = what_if ? !result.first_command : result.all_same() && vision->all_same();
  if (!same) throw CLI::RuntimeError(kExitNo);
}

}  // namespace

void add_replay_command(CLI::App& app) {
  auto options = std::make_shared<ReplayCommandOptions>();
  CLI::App* command = app.add_subcommand(
      "replay",
      "Runs a recording through this version of heel, the control side and, where it has lossless pictures,\n"
      "vision: the same to the bit, or where it differs. Exit status 0 the same, 1 they differ, 2 the "
      "recording cannot be used");
  command
      ->add_option("recording", options->recording,
                   "a recording (*.mcap), or a folder of which the newest one is taken")
      ->required()
      ->type_name("RECORDING");
  command->add_flag("--diff", options->diff, "print every quantity that differs, over all ticks");
  command
      ->add_option("--plot", options->plot,
                   "folder for replay.csv and the picture replay.png, replay.svg of the commands")
      ->type_name("DIR");
  command
      ->add_option("--set", options->settings,
                   "KEY=VALUE: what heel would have done with this value, up to the first command that\n"
                   "differs; several times for several keys")
      ->type_name("KEY=VALUE");
  command->add_flag("--json", options->json,
                    "one JSON object, with every quantity that differs (default: text)");
  command->callback([options] { run_replay(*options); });
}

}  // namespace heel::cli
