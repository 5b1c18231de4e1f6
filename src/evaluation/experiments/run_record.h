// A lock-step run's records: metrics always; CSV files, sample frames and the template where asked.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "evaluation/metrics/metrics.h"
#include "sim/lockstep/lockstep.h"
#include "telemetry/recorder.h"

namespace heel::evaluation {

/// Samples for the metrics from a run's records.
MotionSample motion_sample(const sim::TruthMoment& truth);
PoseSample pose_sample(const PoseEstimate& pose, const sim::TruthMoment& truth);
TickSample tick_sample(const TickRecord& tick);

class RunRecord : public sim::LockstepObserver {
 public:
  /// `directory` empty: metrics only. Writes ticks.csv, poses.csv, truth.csv, wire.hex, shirt.heel and about
  /// twelve frames. Throws heel::Error when the folder cannot be written.
  RunRecord(const std::string& directory, const sim::LockstepSettings& settings);

  void on_tick(const TickRecord& tick, const sim::TruthMoment& truth) override;
  void on_pose(const FrameView& frame, const PoseEstimate& pose, const sim::TruthMoment& truth) override;
  void on_bytes_to_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) override;

  const MetricsCollector& metrics() const { return metrics_; }
  /// Everything told so far is in the files.
  void flush();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  using File = std::unique_ptr<std::FILE, Close>;
  static File create(const std::string& path);
  void write_truth(const sim::TruthMoment& truth);
  void save_frame(const FrameView& frame) const;

  std::string directory_;
  MetricsCollector metrics_;
  std::unique_ptr<Recorder> recorder_;
  File truth_;
  File wire_;
  TimeNs frame_interval_ns_ = 0;
  TimeNs t_next_frame_ns_ = 0;
};

}  // namespace heel::evaluation
