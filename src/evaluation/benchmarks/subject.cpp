#include "evaluation/benchmarks/subject.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "realtime/thread_clock.h"

namespace heel::evaluation {
namespace {

double ms_from_ns(TimeNs ns) {
  return static_cast<double>(ns) / static_cast<double>(kNsPerMs);
}

TimeNs sum_ns(const std::vector<TimeNs>& samples_ns) {
  return std::accumulate(samples_ns.begin(), samples_ns.end(), TimeNs{0});
}

}  // namespace

void CpuStageTimes::begin() {
  spent_ns_.fill(0);
  last_ns_ = thread_cpu_ns();
}

void CpuStageTimes::ended(VisionStage stage) {
  const TimeNs now_ns = thread_cpu_ns();
  spent_ns_[static_cast<std::size_t>(stage)] += now_ns - last_ns_;
  last_ns_ = now_ns;
}

/// Quantiles are samples (nearest rank): the p99 of a short run is its largest.
Times summarise(std::vector<TimeNs> samples_ns) {
  if (samples_ns.empty()) return {};
  std::sort(samples_ns.begin(), samples_ns.end());
  const auto rank = [&](double share) {
    const double size = static_cast<double>(samples_ns.size());
    return samples_ns[static_cast<std::size_t>(std::max(1.0, std::ceil(share * size))) - 1];
  };
  return {samples_ns.size(), ms_from_ns(samples_ns.front()), ms_from_ns(rank(0.5)), ms_from_ns(rank(0.99))};
}

Subject::Subject(Figure what, int repeats) : figure_(std::move(what)), repeats_(repeats) {}

void Subject::warm_up(std::size_t frame) {
  stage_times_.begin();
  work(frame);
}

void Subject::run(std::size_t frame) {
  stage_times_.begin();
  const TimeNs begin_ns = thread_cpu_ns();
  for (int i = 0; i < repeats_; ++i) work(frame);
  const TimeNs took_ns = (thread_cpu_ns() - begin_ns) / repeats_;
  if (!settle(frame)) return;
  samples_ns_.push_back(took_ns);
  for (std::size_t i = 0; i < kVisionStages; ++i)
    stage_samples_ns_[i].push_back(stage_times_.spent_ns()[i] / repeats_);
}

Figure Subject::result() const {
  Figure figure = figure_;
  figure.times = summarise(samples_ns_);
  TimeNs staged_ns = 0;
  for (std::size_t i = 0; i < kVisionStages; ++i) {
    const TimeNs total_ns = sum_ns(stage_samples_ns_[i]);
    if (total_ns == 0) continue;
    staged_ns += total_ns;
    figure.stages.push_back({static_cast<VisionStage>(i), summarise(stage_samples_ns_[i])});
  }
  const TimeNs whole_ns = sum_ns(samples_ns_);
  if (whole_ns > 0) figure.stage_share = static_cast<double>(staged_ns) / static_cast<double>(whole_ns);
  complete(figure);
  return figure;
}

}  // namespace heel::evaluation
