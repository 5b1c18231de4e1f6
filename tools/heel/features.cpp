// heel features: the features of one image, as a KPD file that other tools can score and compare.
#include "heel/features.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "commands.h"
#include "files/image_file.h"
#include "files/kpd_file.h"
#include "heel/error.h"

namespace heel::cli {
namespace {

struct FeaturesOptions {
  std::string image;
  std::string output;
  FeatureSettings settings;
  bool json = false;
};

void write_features(const FeaturesOptions& options) {
  const GreyImage image = read_grey_image(options.image);
  const cv::Mat& grey = image.grey;
  for (const std::string& said : {image.note, image.missing})
    if (!said.empty()) fmt::print(stderr, "{}: {}\n", options.image, said);
  FeatureExtractor extractor(grey.cols, grey.rows, options.settings);
  FeatureSet features;
  extractor.reserve(features);
  const auto start = std::chrono::steady_clock::now();
  extractor.extract(frame_view_of(grey), features);
  const std::chrono::duration<double, std::milli> elapsed_ms = std::chrono::steady_clock::now() - start;

  write_kpd_file(features, grey.cols, grey.rows, options.output);
  if (options.json) {
    const nlohmann::ordered_json json{{"image", options.image},
                                      {"output", options.output},
                                      {"features", features.features.size()},
                                      {"ms", elapsed_ms.count()}};
    fmt::print("{}\n", json.dump(2));
    return;
  }
  fmt::print(stderr, "{} features in {:.2f} ms\n", features.features.size(), elapsed_ms.count());
}

}  // namespace

void add_features_command(CLI::App& app) {
  auto options = std::make_shared<FeaturesOptions>();
  options->settings = {.octaves = 3, .max_features = 5000, .threshold = 2e-5f, .spread = false};
  CLI::App* command = app.add_subcommand("features",
                                         "The SURF features of an image, strongest first, as a KPD file: "
                                         "text when its name ends in .txt, else binary.");
  command->add_option("image", options->image, "image to read")->required()->type_name("IMAGE");
  command->add_option("-o,--output", options->output, "file to write")->required()->type_name("OUT.kpd");
  command->add_option("--max", options->settings.max_features, "largest number of features written")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000000));
  command->add_option("--octaves", options->settings.octaves, "octaves of scale")
      ->capture_default_str()
      ->check(CLI::Range(1, 4));
  command->add_option("--threshold", options->settings.threshold, "smallest Hessian determinant of a feature")
      ->capture_default_str()
      ->check(CLI::Range(0.f, 1.f));
  command->add_flag("--oriented", options->settings.oriented,
                    "descriptors relative to the dominant orientation");
  command->add_flag("--spread", options->settings.spread,
                    "spread the features evenly over the cells of a grid");
  command->add_flag("--json", options->json,
                    "one JSON object: features, ms, output (default: a line on stderr)");
  command->callback([options] { write_features(*options); });
}

}  // namespace heel::cli
