// What is recorded of a lock-step run: samples for the metrics and, in a folder, the recording, the truth,
// some frames and the template.
#pragma once

#include <memory>
#include <string>

#include "evaluation/metrics/metrics.h"
#include "files/sampled_csv.h"
#include "sim/lockstep/lockstep.h"
#include "sim/transport/wire_file.h"
#include "telemetry/recorder.h"

namespace heel::evaluation {

// Samples for the metrics, made of a run's records.
MotionSample motion_sample(const sim::LockstepTruth& truth);
PoseSample pose_sample(const PoseEstimate& pose, const sim::LockstepTruth& truth);
TickSample tick_sample(const TickRecord& tick);
/// The set distance and the gate's limit of a run.
FollowReference follow_reference(const sim::LockstepSettings& settings);

class RunRecord : public sim::LockstepObserver {
 public:
  /// Writes run.mcap, truth.csv, wire.hex, shirt.heel and about twelve frames, in place of those of an
  /// earlier run; nothing when `directory` is empty. Throws heel::Error when the folder cannot be written.
  RunRecord(const std::string& directory, const sim::LockstepSettings& settings);

  void on_tick(const TickRecord& tick, const sim::LockstepTruth& truth) override;
  void on_pose(const FrameView& frame, const PoseEstimate& pose, const sim::LockstepTruth& truth) override;
  void on_bytes_to_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) override;
  void on_bytes_from_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) override;

  const MetricsCollector& metrics() const { return metrics_; }
  /// Hands all records so far to the operating system.
  void flush();

 private:
  void attach_vision_files(const sim::LockstepSettings& settings);
  void open_truth(bool has_world);

  std::string directory_;
  MetricsCollector metrics_;
  std::unique_ptr<Recorder> recorder_;  ///< this and the files: null without a directory
  std::unique_ptr<SampledCsv> truth_file_;
  sim::LockstepTruth truth_;  ///< of the row being written
  std::unique_ptr<sim::WireFile> wire_;
  std::string pictures_ = "none";  ///< telemetry.pictures
  TimeNs frame_interval_ns_ = 0;
  TimeNs t_next_frame_ns_ = 0;
};

}  // namespace heel::evaluation
