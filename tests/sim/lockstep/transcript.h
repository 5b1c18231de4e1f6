// Everything that a lock-step run gives: what its observer sees, and every file of its recording.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "evaluation/experiments/run_record.h"
#include "sim/lockstep/lockstep.h"
#include "sim/scene/truth_columns.h"
#include "support/decisions.h"
#include "support/pose_bytes.h"
#include "support/temporary_folder.h"

namespace heel::test {

/// Bytes by name. Equal transcripts: the runs are the same to the bit.
using Transcript = std::map<std::string, std::string>;

/// Writes down what the recording rounds or leaves out, and passes everything on to it.
class TranscriptObserver : public sim::LockstepObserver {
 public:
  TranscriptObserver(const std::string& directory, const sim::LockstepSettings& settings)
      : record_(directory, settings) {}

  void on_tick(const TickRecord& tick, const sim::LockstepTruth& truth) override {
    std::string& bytes = transcript["ticks"];
    append(bytes, tick.input.now_ns, tick.input.robot.odometry.t_ns);
    for (const SonarEcho& echo : tick.input.robot.sonar) append(bytes, echo.t_ns, echo.range_m);
    bytes += decision_bytes(tick);
    append_truth(truth);
    record_.on_tick(tick, truth);
  }
  void on_pose(const FrameView& frame, const PoseEstimate& pose, const sim::LockstepTruth& truth) override {
    const FrameHeader& header = frame.header;
    append(transcript["frame headers"], header.sequence, header.t_capture_ns, header.width_px,
           header.height_px);
    for (std::uint32_t row = 0; frame.grey != nullptr && row < header.height_px; ++row)
      transcript["frames"].append(reinterpret_cast<const char*>(frame.grey) + row * frame.stride_bytes,
                                  header.width_px);
    transcript["poses"] += pose_bytes(pose);
    append_truth(truth);
    record_.on_pose(frame, pose, truth);
    poses_found += pose.found();
  }
  void on_bytes_to_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) override {
    append(transcript["bytes to the robot"], t_ns);
    transcript["bytes to the robot"].append(bytes.begin(), bytes.end());
    record_.on_bytes_to_robot(bytes, t_ns);
  }
  void on_bytes_from_robot(std::span<const std::uint8_t> bytes, TimeNs t_ns) override {
    record_.on_bytes_from_robot(bytes, t_ns);
  }
  void flush() { record_.flush(); }

  Transcript transcript;
  int poses_found = 0;

 private:
  template <typename... Values>
  static void append(std::string& bytes, const Values&... values) {
    static_assert(((std::is_arithmetic_v<Values> || std::is_enum_v<Values>)&&...), "no padding");
    (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  }
  void append_truth(const sim::LockstepTruth& truth) {
    std::string& bytes = transcript["truth"];
    const sim::RobotTruth& robot = truth.robot;
    append(bytes, truth.t_ns, truth.walking, robot.pose.x_m, robot.pose.y_m, robot.pose.heading_rad,
           robot.v_m_s, robot.yaw_rate_rad_s, robot.odometry.x_m, robot.odometry.y_m,
           robot.odometry.heading_rad, robot.session, robot.motors_enabled);
    if (!truth.has_world) return;
    for (const sim::TruthColumn& column : sim::world_truth_columns())
      append(bytes, column.value(truth.world));
  }

  evaluation::RunRecord record_;
};

/// Runs the whole scenario. `poses_found`, where given: how many frames showed the shirt.
inline Transcript transcript_of(const sim::LockstepSettings& settings, int* poses_found = nullptr) {
  const TemporaryFolder folder;
  TranscriptObserver observer(folder.path().string(), settings);
  const sim::LockstepCounts counts = sim::run_lockstep(settings, observer);
  observer.flush();
  if (poses_found != nullptr) *poses_found = observer.poses_found;
  Transcript transcript = std::move(observer.transcript);
  for (const std::uint64_t count :
       {counts.ticks, counts.frames, counts.frames_overtaken, counts.frames_dropped})
    transcript["counts"] += std::to_string(count) + " ";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (!entry.is_regular_file()) continue;
    std::string bytes = read_text(entry.path().string());
    transcript[entry.path().lexically_relative(folder.path()).string()] = std::move(bytes);
  }
  return transcript;
}

/// Names of what differs between two runs.
inline std::vector<std::string> differences(const Transcript& a, const Transcript& b) {
  std::vector<std::string> names;
  for (const auto& [name, bytes] : a)
    if (!b.contains(name) || b.at(name) != bytes) names.push_back(name);
  for (const auto& [name, bytes] : b)
    if (!a.contains(name)) names.push_back(name);
  return names;
}

}  // namespace heel::test
