#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "config/config_load.h"
#include "experiment_options.h"

namespace heel::cli {

VisionConfig vision_of(const ExperimentOptions& options) {
  return options.config_file.empty() ? VisionConfig{} : load_config(options.config_file).config.vision;
}

std::string data_folder(const ExperimentOptions& options) {
  if (!options.data.empty()) return options.data;
  const char* given = std::getenv("HEEL_TEST_DATA");
  return given != nullptr && *given != '\0' ? given : "../shared/data";
}

void ExperimentResults::add(const std::string& name, const ExperimentJson& result, const std::string& text) {
  if (as_json_) {
    ExperimentJson one{{"name", name}};
    one.update(result);
    all_.push_back(one);
    return;
  }
  fmt::print("{}", text);
  std::fflush(stdout);
}

void ExperimentResults::skip(const std::string& name, const std::string& why) {
  add(name, {{"skipped", why}}, fmt::format("{:<10} SKIPPED: {}\n", name, why));
}

void ExperimentResults::end() const {
  if (as_json_) fmt::print("{}\n", ExperimentJson{{"experiments", all_}}.dump(2));
}

}  // namespace heel::cli
