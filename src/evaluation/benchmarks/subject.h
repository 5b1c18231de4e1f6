// Something that is run on every frame, in turns with all the others, and timed.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "evaluation/benchmarks/vision_bench.h"

namespace heel::evaluation {

/// Adds up the CPU time between marks, stage by stage.
class CpuStageTimes : public StageTimes {
 public:
  void begin();
  void ended(VisionStage stage) override;
  const std::array<TimeNs, kVisionStages>& spent_ns() const { return spent_ns_; }

 private:
  std::array<TimeNs, kVisionStages> spent_ns_{};
  TimeNs last_ns_ = 0;
};

class Subject {
 public:
  /// Short work is done `repeats` times in a row, and the time divided by it.
  explicit Subject(Figure what, int repeats = 1);
  virtual ~Subject() = default;
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  void warm_up(std::size_t frame);
  void run(std::size_t frame);
  Figure result() const;

 protected:
  /// What is timed.
  virtual void work(std::size_t frame) = 0;
  /// After it, untimed; false: this frame's time does not belong to the figure.
  virtual bool settle(std::size_t /*frame*/) { return true; }
  /// Adds to the figure what else was found.
  virtual void complete(Figure& /*figure*/) const {}

  /// Times of the stages, for subjects that have stages.
  StageTimes* stage_times() { return &stage_times_; }

 private:
  Figure figure_;
  int repeats_;
  CpuStageTimes stage_times_;
  std::vector<TimeNs> samples_ns_;
  std::array<std::vector<TimeNs>, kVisionStages> stage_samples_ns_;
};

using Subjects = std::vector<std::unique_ptr<Subject>>;

}  // namespace heel::evaluation
