// The command line of `heel experiment`, and where its results go.
#pragma once

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "heel/vision_config.h"

namespace heel::cli {

inline constexpr const char* kReal = "real";
inline constexpr const char* kForeign = "foreign";
inline constexpr const char* kPlanar = "foreign-planar";
inline constexpr const char* kFalse = "foreign-false";
inline constexpr const char* kOtherPeople = "/person/one-by-one.mp4";
inline constexpr const char* kStills = "stills";
inline constexpr const char* kStopping = "stopping";
inline constexpr const char* kFamily = "family";

using ExperimentJson = nlohmann::ordered_json;

struct ExperimentOptions {
  std::vector<std::string> names;
  std::string out;
  std::string scenario;
  std::string config_file;
  double teach_distance_m = 1.5;
  int repeats = 0;
  std::uint64_t seed = 1;
  std::string data;
  std::string foreign_set;
  std::string error_model;
  bool json = false;

  bool wants(const char* name) const { return std::find(names.begin(), names.end(), name) != names.end(); }
};

/// Of --config, else the defaults.
VisionConfig vision_of(const ExperimentOptions& options);
/// The folder of --data, or HEEL_TEST_DATA.
std::string data_folder(const ExperimentOptions& options);

/// The results of each experiment: text at once, or one JSON object at the end.
class ExperimentResults {
 public:
  explicit ExperimentResults(bool json) : as_json_(json) {}
  /// `result`: its fields beside the name.
  void add(const std::string& name, const ExperimentJson& result, const std::string& text);
  void skip(const std::string& name, const std::string& why);
  void end() const;

 private:
  const bool as_json_;
  ExperimentJson all_ = ExperimentJson::array();
};

/// Those of the experiments that search the foreign set.
void run_foreign_experiments(const ExperimentOptions& options, ExperimentResults& results);

}  // namespace heel::cli
