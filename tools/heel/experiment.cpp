// heel experiment: the paper's experiments, and others, on the rendered world and on pictures of others; CSV
// files for heel report.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "commandline/progress.h"
#include "commands.h"
#include "config/config_load.h"
#include "evaluation/experiments/back_set.h"
#include "evaluation/experiments/real_images.h"
#include "evaluation/experiments/still_image_cases.h"
#include "evaluation/experiments/still_image_file.h"
#include "evaluation/experiments/stop_distances.h"
#include "experiment_family.h"
#include "experiment_options.h"
#include "files/folder.h"
#include "files/image_file.h"
#include "heel/error.h"
#include "sim/lockstep/lockstep.h"

namespace heel::cli {
namespace {

constexpr int kVideoStep = 3;  ///< ten frames a second show how certainty rises and falls

sim::Scenario base_scenario(const ExperimentOptions& options) {
  if (!options.scenario.empty()) return sim::read_scenario(options.scenario);
  sim::Scenario scenario;
  scenario.camera.model = sim::default_camera_model();
  return scenario;
}

/// Writes each picture of a case as FOLDER/NNN.png.
evaluation::PictureCallback picture_writer(const std::string& folder, const CameraModel& camera) {
  make_folder(folder);
  return [folder, camera](std::size_t index, const std::vector<std::uint8_t>& grey) {
    write_grey_image(fmt::format("{}/{:03}.png", folder, index), grey.data(), camera.width_px,
                     camera.height_px);
  };
}

void run_still_experiment(const evaluation::StillImageExperiment& chosen, const ExperimentOptions& options,
                          ExperimentResults& results) {
  const sim::Scenario base = base_scenario(options);
  Config config;
  if (!options.config_file.empty()) config = load_config(options.config_file).config;
  sim::apply_scenario(base, config);
  evaluation::PictureCallback on_picture;
  if (chosen.writes_pictures) on_picture = picture_writer(options.out + "/" + chosen.name, base.camera.model);
  commandline::Progress progress(std::string(chosen.name) + ", poses");
  const auto on_progress = [&](std::size_t done, std::size_t of) { progress.show(done, of); };
  const auto rows =
      evaluation::run_still_images(base, chosen.cases(options.repeats > 0 ? options.repeats : chosen.repeats),
                                   options.teach_distance_m, config.vision, on_picture, on_progress);
  const auto found =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.pose.found(); });
  const std::string file = options.out + "/" + chosen.name + ".csv";
  evaluation::write_still_images(rows, file);
  progress.clear();
  results.add(chosen.name, {{"file", file}, {"pictures", rows.size()}, {"found", found}},
              fmt::format("{:<10} {} pictures, found in {}: {}\n", chosen.name, rows.size(), found, file));
}

/// Throws where a folder that the command line names cannot hold the pictures that are asked for. In the
/// default folder absent pictures are skipped.
void require_given_folders(const ExperimentOptions& options) {
  namespace fs = std::filesystem;
  std::error_code unused;
  const bool foreign = options.wants(kForeign) || options.wants(kPlanar) || options.wants(kFalse);
  if (const std::string& set = options.foreign_set; !set.empty() && !fs::is_directory(set, unused))
    throw Error(fmt::format(
        "--foreign-set {}: no such folder (expected one that holds images/, truth.csv and camera.yaml)",
        set));
  const std::string& data = options.data;
  if (data.empty()) return;
  const auto holds = [&](const char* name) { return fs::exists(data + name, unused); };
  if (!fs::is_directory(data, unused))
    throw Error(fmt::format("--data {}: no such folder (expected one that holds {})", data,
                            foreign && !options.wants(kReal) ? "foreign/" : "oxford/ and person/"));
  if (options.wants(kReal) && !holds("/oxford") && !holds("/person"))
    throw Error(fmt::format(
        "--data {}: no real pictures in this folder (expected one that holds oxford/ and person/)", data));
  if (foreign && options.foreign_set.empty() && !holds("/foreign"))
    throw Error(
        fmt::format("--data {}: no foreign set in this folder (expected one that holds foreign/)", data));
}

void run_real_image_experiment(const ExperimentOptions& options, ExperimentResults& results) {
  const std::string data = data_folder(options);
  const VisionConfig vision;
  const auto pairs = evaluation::estimate_pairs(data, vision);
  if (!pairs.empty()) evaluation::write_pairs(pairs, options.out + "/real_pairs.csv");
  const auto video = evaluation::estimate_video(data, kVideoStep, vision);
  if (!video.empty()) evaluation::write_video(video, options.out + "/real_video.csv");
  if (!options.data.empty() && pairs.empty() && video.empty())
    throw Error(
        fmt::format("--data {}: no pairs in oxford/ and no video in person/ (expected at least one of them)",
                    options.data));
  const bool complete = !pairs.empty() && !video.empty();
  results.add(kReal, {{"pairs", pairs.size()}, {"video_frames", video.size()}, {"complete", complete}},
              fmt::format("{:<10} {} pairs, {} frames of video{}\n", kReal, pairs.size(), video.size(),
                          complete ? "" : ": SKIPPED where absent in " + data));
}

/// A test set of pictures with truth, in the layout of the set that others' programs made.
void write_stills(const ExperimentOptions& options, ExperimentResults& results) {
  const std::string folder = options.out + "/" + kStills;
  commandline::Progress progress(std::string(kStills) + ", pictures");
  const std::size_t pictures =
      evaluation::write_back_set(folder, options.seed, [&](std::size_t done) { progress.show(done); });
  progress.clear();
  results.add(kStills, {{"folder", folder}, {"pictures", pictures}},
              fmt::format("{:<10} {} pictures with truth: {}\n", kStills, pictures, folder));
}

/// Stops by each trigger at each speed, in the world without pictures.
void measure_stopping(const ExperimentOptions& options, ExperimentResults& results) {
  if (options.error_model.empty())
    throw Error("stopping needs --error-model FILE (expected as for heel simulate)");
  const Config config = options.config_file.empty() ? Config{} : load_config(options.config_file).config;
  commandline::Progress progress(std::string(kStopping) + ", stops");
  const auto stops =
      evaluation::measure_stops(config, sim::read_error_model(options.error_model), options.seed,
                                [&](std::size_t done, std::size_t of) { progress.show(done, of); });
  progress.clear();
  const std::string file = options.out + "/" + kStopping + ".csv";
  evaluation::write_stop_distances(stops, file);
  results.add(kStopping, {{"file", file}, {"stops", stops.size()}},
              fmt::format("{}{:<10} {} stops: {}\n", evaluation::stop_distance_table(stops, config),
                          kStopping, stops.size(), file));
}

void run_experiments(const ExperimentOptions& options) {
  require_given_folders(options);
  make_folder(options.out);
  ExperimentResults results(options.json);
  if (options.wants(kStills)) write_stills(options, results);
  if (options.wants(kStopping)) measure_stopping(options, results);
  if (options.wants(kFamily)) measure_family(options, results);
  if (options.wants(kReal)) run_real_image_experiment(options, results);
  if (options.wants(kForeign) || options.wants(kPlanar) || options.wants(kFalse))
    run_foreign_experiments(options, results);
  for (const evaluation::StillImageExperiment& known : evaluation::still_image_experiments())
    if (options.wants(known.name)) run_still_experiment(known, options, results);
  results.end();
}

}  // namespace

void add_experiment_command(CLI::App& app) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = app.add_subcommand("experiment",
                                         "Estimates the pose of persons in rendered and in other pictures "
                                         "whose truth is known; writes NAME.csv\n"
                                         "for `heel report`");
  std::vector<std::string> names;
  std::string help = "one or more of:";
  for (const evaluation::StillImageExperiment& known : evaluation::still_image_experiments()) {
    names.emplace_back(known.name);
    help += std::string("\n  ") + known.name + ": " + known.what;
  }
  names.emplace_back(kStills);
  help += std::string("\n  ") + kStills +
          ": writes pictures of backs with truth: images/, truth.csv, camera.yaml";
  names.emplace_back(kStopping);
  help += std::string("\n  ") + kStopping + ": how far the robot rolls after each kind of stop, by speed";
  names.emplace_back(kFamily);
  help += std::string("\n  ") + kFamily +
          ": each robot that heel knows: its odometry against the truth, and its stop before a wall";
  names.emplace_back(kReal);
  help += std::string("\n  ") + kReal + ": homography error on real pairs, certainty over a real video";
  names.insert(names.end(), {kForeign, kPlanar, kFalse});
  help += std::string("\n  ") + kForeign +
          ": pictures of people by others, with truth: what is found, and the errors" + "\n  " + kPlanar +
          ": planar matching by OpenCV on the same pictures" + "\n  " + kFalse +
          ": every shirt searched for in pictures that do not show it";
  command->add_option("name", options->names, help)->required()->check(CLI::IsMember(names));
  command->add_option("-o,--out", options->out, "folder for CSV files and pictures")
      ->required()
      ->type_name("DIR");
  command->add_flag("--json", options->json, "one JSON object with a list `experiments` (default: text)");
  command
      ->add_option("--repeats", options->repeats,
                   "pictures of each pose, at most eight worlds; for `errors`: poses in thousands")
      ->check(CLI::Range(1, 1000));
  command->add_option("--seed", options->seed, "of `stills`: other persons, prints, folds and rooms")
      ->check(whole_number("a whole number"))
      ->capture_default_str();
  command
      ->add_option("--data", options->data,
                   "folder of the real pictures (default: HEEL_TEST_DATA, else ../shared/data)")
      ->type_name("DIR");
  command
      ->add_option("--foreign-set", options->foreign_set,
                   "folder of the foreign set: images/, truth.csv, camera.yaml (default: foreign in --data)")
      ->type_name("DIR");
  command
      ->add_option("--scenario", options->scenario,
                   "uses the camera, light and person of this scenario (default: the simulator's defaults)")
      ->type_name("SCENARIO");
  command
      ->add_option("--error-model", options->error_model,
                   "of `stopping`: the file that poses are sampled from, as for heel simulate")
      ->type_name("MODEL.toml");
  command
      ->add_option("--config", options->config_file,
                   "the daemon's configuration file (default: every key at its default)")
      ->type_name("FILE");
  command->add_option("--teach-distance", options->teach_distance_m, "of the reference view, metres")
      ->check(CLI::Range(0.3, 10.0))
      ->capture_default_str();
  command->callback([options] { run_experiments(*options); });
}

}  // namespace heel::cli
