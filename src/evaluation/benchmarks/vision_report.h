// What was measured, for programs and for people.
#pragma once

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>
#include <string>

#include "evaluation/benchmarks/machine.h"
#include "evaluation/benchmarks/vision_bench.h"

namespace heel::evaluation {

/// A stage's name in JSON and in words.
struct StageName {
  const char* key;
  const char* label;
};
const StageName& name_of(VisionStage stage);

/// All that a report shows.
struct VisionReport {
  Machine machine;
  std::string source;
  cv::Size size;
  std::size_t frames = 0;  ///< measured
  VisionBench bench;
};

nlohmann::ordered_json to_json(const VisionReport& report);
std::string table(const VisionReport& report);

}  // namespace heel::evaluation
