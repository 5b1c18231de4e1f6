// The vision stages beside their yardsticks, measured frame by frame in turns, so that the noise of a shared
// machine hits all alike.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/benchmarks/bench_input.h"
#include "heel/stage_times.h"

namespace heel::evaluation {

/// Over the frames of a run; of each frame the thread's CPU time.
struct Times {
  std::size_t count = 0;  ///< all else is 0 without any
  double min_ms = 0.0;
  double median_ms = 0.0;
  double p99_ms = 0.0;
};
Times summarise(std::vector<TimeNs> samples_ns);

struct StageFigure {
  VisionStage stage = VisionStage::Integral;
  Times times;
};

/// Something measured. Ratios are of medians.
struct Figure {
  std::string key{};             ///< in JSON
  std::string label{};           ///< for people
  std::string yardstick{};       ///< key of the yardstick; empty: it is one itself
  std::optional<double> goal{};  ///< the largest ratio to reach; none at sizes for which there is no goal
  Times times{};
  std::optional<double> features{};         ///< found in a frame, on average
  std::optional<double> corner_error_px{};  ///< of the homographies, median
  std::optional<double> found_share{};      ///< of the frames in which the shirt was found
  std::optional<double> pixels{};           ///< of a frame, where they are not the run's
  std::vector<StageFigure> stages{};        ///< those that the frames went through, in order
  double stage_share = 0.0;                 ///< of the whole time, what the stages account for
};

/// What a step ought to take at best, judged on another machine, beside what it takes here.
struct CostModel {
  std::string key;
  std::string label;
  double low_ms = 0.0, high_ms = 0.0;  ///< as measured there, times `machine_scale`
  double measured_ms = 0.0;            ///< median
  double ratio() const { return measured_ms / (0.5 * (low_ms + high_ms)); }
};

struct VisionBench {
  std::vector<Figure> figures;     ///< heel's
  std::vector<Figure> yardsticks;  ///< others'
  std::uint32_t template_features = 0;
  double tracked_share = 0.0;          ///< frames in which the tracker had not to search everywhere
  double found_share = 0.0;            ///< frames in which the search found the shirt
  double machine_scale = 0.0;          ///< cv::ORB(1000) here / where the cost models were measured
  std::vector<CostModel> cost_models;  ///< at 640 × 480 only
  double cpu_share = 0.0;              ///< CPU time / time on the wall: 1 on a quiet machine

  const Figure* find(const std::string& key) const;
  /// None without a yardstick, or where one of the two was never measured.
  std::optional<double> ratio(const Figure& figure) const;
  std::optional<double> ratio(const Times& times, const std::string& yardstick) const;
};

/// Measures every frame but the first once. `progress` hears of every frame done. Throws heel::Error when the
/// template and the frames do not fit together. `far_shirt` adds the search in large pictures with a small
/// shirt; null: without.
VisionBench measure_vision(const BenchInput& input, const BenchInput* far_shirt,
                           const std::function<void(std::size_t)>& progress);

}  // namespace heel::evaluation
