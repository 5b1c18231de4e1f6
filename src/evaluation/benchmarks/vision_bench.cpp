#include "evaluation/benchmarks/vision_bench.h"

#include <chrono>
#include <utility>

#include "evaluation/benchmarks/subjects.h"
#include "heel/error.h"
#include "realtime/thread_clock.h"

namespace heel::evaluation {
namespace {

// The cost models were measured where cv::ORB(1000) took this long at 640 × 480.
constexpr double kModelOrb_ms = 7.1;

/// Every subject that is timed; search and tracking also report what they found.
struct AllSubjects {
  Subjects subjects;
  const PipelineSubject* search = nullptr;
  const PipelineSubject* tracking = nullptr;

  explicit AllSubjects(const BenchInput& input) {
    std::unique_ptr<PipelineSubject> searcher = search_subject(input), tracker = tracking_subject(input);
    search = searcher.get();
    tracking = tracker.get();
    subjects.push_back(std::move(searcher));
    subjects.push_back(std::move(tracker));
    subjects.push_back(features_subject(input));
    add(matcher_subjects(input));
    add(geometry_subjects());
    add(opencv_features_subjects(input));
  }

  void add(Subjects more) {
    for (auto& subject : more) subjects.push_back(std::move(subject));
  }
};

/// The order of the subjects changes with each frame, so that none always runs after the same one, with the
/// same contents of the caches.
void run_all(Subjects& subjects, std::size_t frames, const std::function<void(std::size_t)>& progress) {
  for (auto& subject : subjects) subject->warm_up(0);
  for (std::size_t frame = 1; frame < frames; ++frame) {
    for (std::size_t i = 0; i < subjects.size(); ++i) subjects[(i + frame) % subjects.size()]->run(frame);
    progress(frame);
  }
}

double stage_median_ms(const Figure& figure, VisionStage stage) {
  for (const StageFigure& s : figure.stages)
    if (s.stage == stage) return s.times.median_ms;
  return 0.0;
}

std::vector<CostModel> cost_models(const VisionBench& bench) {
  const Figure& features = *bench.find("features");
  const double scale = bench.machine_scale;
  const auto model = [&](const char* key, const char* label, double low_ms, double high_ms,
                         double measured_ms) {
    return CostModel{key, label, scale * low_ms, scale * high_ms, measured_ms};
  };
  const double description_ms = 1.8e-3 * features.features.value_or(0.0);
  return {
      model("integral", "integral image", 0.13, 0.13, stage_median_ms(features, VisionStage::Integral)),
      model("hessian", "fast-Hessian, 2 octaves", 1.4, 1.9, stage_median_ms(features, VisionStage::Hessian)),
      model("description", "descriptors, 1.8 us each", description_ms, description_ms,
            stage_median_ms(features, VisionStage::Description)),
      model("matcher", "matching 300 x 1000", 0.23, 0.23, bench.find("matcher")->times.median_ms),
  };
}

}  // namespace

const Figure* VisionBench::find(const std::string& key) const {
  for (const auto* list : {&figures, &yardsticks})
    for (const Figure& figure : *list)
      if (figure.key == key) return &figure;
  return nullptr;
}

std::optional<double> VisionBench::ratio(const Times& times, const std::string& yardstick) const {
  const Figure* other = find(yardstick);
  if (times.count == 0 || other == nullptr || !(other->times.median_ms > 0.0)) return {};
  return times.median_ms / other->times.median_ms;
}

std::optional<double> VisionBench::ratio(const Figure& figure) const {
  return ratio(figure.times, figure.yardstick);
}

VisionBench measure_vision(const BenchInput& input, const BenchInput* far_shirt,
                           const std::function<void(std::size_t)>& progress) {
  if (input.frames.size() < 2)
    throw Error(input.source + ": frames: " + std::to_string(input.frames.size()) +
                " (expected 2 or more, the first for warming up)");
  AllSubjects field(input);
  const auto wall_begin = std::chrono::steady_clock::now();
  const TimeNs cpu_begin_ns = thread_cpu_ns();
  run_all(field.subjects, input.frames.size(), progress);
  if (far_shirt != nullptr) {
    Subjects more = far_shirt_subjects(*far_shirt);
    run_all(more, far_shirt->frames.size(), [](std::size_t /*frame*/) {});
    field.add(std::move(more));
  }
  const double cpu_s = seconds_from_ns(thread_cpu_ns() - cpu_begin_ns);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_begin).count();

  VisionBench bench;
  for (const auto& subject : field.subjects) {
    Figure figure = subject->result();
    (figure.yardstick.empty() ? bench.yardsticks : bench.figures).push_back(std::move(figure));
  }
  bench.template_features = field.search->template_features();
  bench.found_share = field.search->found_share();
  bench.tracked_share = field.tracking->tracked_share();
  bench.cpu_share = cpu_s / wall_s;
  bench.machine_scale = bench.find("orb_1000")->times.median_ms / kModelOrb_ms;
  if (input.frames.front().grey.size() == kGoalSize) bench.cost_models = cost_models(bench);
  return bench;
}

}  // namespace heel::evaluation
