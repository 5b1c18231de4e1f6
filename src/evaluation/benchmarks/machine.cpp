#include "evaluation/benchmarks/machine.h"

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <thread>

#include "vision/features/simd_target.h"

namespace heel::evaluation {
namespace {

/// "model name" on x86, "Model" or nothing on ARM.
std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  std::string model;
  for (std::string line; std::getline(info, line);) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    if (line.starts_with("model name")) return line.substr(colon + 2);
    if (line.starts_with("Model")) model = line.substr(colon + 2);
  }
  return model.empty() ? "unknown" : model;
}

}  // namespace

Machine this_machine() {
  Machine machine;
  machine.cpu = cpu_name();
  machine.cores = std::thread::hardware_concurrency();
  machine.simd = simd_target_name();
  machine.opencv = cv::getVersionString();
  double load = 0.0;
  if (getloadavg(&load, 1) == 1) machine.load_1min = load;
  return machine;
}

nlohmann::ordered_json json_of(const Machine& machine) {
  return {{"cpu", machine.cpu},
          {"cores", machine.cores},
          {"highway_target", machine.simd},
          {"opencv", machine.opencv},
          {"load_1min", machine.load_1min}};
}

}  // namespace heel::evaluation
