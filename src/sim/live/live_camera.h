// The simulated camera in real time: a thread of its own draws what the robot's camera sees and hands it to
// a sink. Drawing never holds up the robot: the two share one small record under a lock that
// nobody keeps for longer than a copy.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "sim/live/frame_sink.h"
#include "sim/robot/p3at.h"
#include "sim/scene/world.h"

namespace heel::sim {

/// Where the robot was last, for the camera's thread.
class SharedMotion {
 public:
  void set(const RobotTruth& truth);
  /// Carried on from the last record to `t_ns` at its speed.
  RobotMotion at(TimeNs t_ns) const;

 private:
  mutable std::mutex mutex_;
  RobotTruth truth_;
};

struct LiveCameraCounters {
  std::uint64_t frames = 0;
  std::uint64_t frames_late = 0;     ///< left out: drawing had not kept up
  std::uint64_t frames_dropped = 0;  ///< on purpose: the scenario's share
  double draw_ms_mean = 0.0;
  double draw_ms_worst = 0.0;
};

class LiveCamera {
 public:
  /// Frames begin at `t_start_ns` (CLOCK_MONOTONIC), which is time 0 of world and robot. Every
  /// `saved_every_s` one is kept in `saved_folder` (none when empty). Throws heel::Error when that cannot be
  /// made. A sink that fails later ends the camera, with a line that says so, and not the robot.
  LiveCamera(World& world, const SharedMotion& motion, std::unique_ptr<FrameSink> sink, TimeNs t_start_ns,
             const std::string& saved_folder, double saved_every_s);
  ~LiveCamera();
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  LiveCameraCounters counters() const;

 private:
  void run();
  void save(std::uint64_t sequence, TimeNs t_ns);
  void draw(std::uint64_t sequence, TimeNs t_ns);
  TimeNs readable_ns(TimeNs t_ns) const;

  World& world_;
  const SharedMotion& motion_;
  std::unique_ptr<FrameSink> sink_;
  TimeNs t_start_ns_;
  std::string saved_folder_;
  TimeNs saved_every_ns_;
  TimeNs t_save_ns_;
  std::vector<std::uint8_t> grey_;
  mutable std::mutex counters_mutex_;
  LiveCameraCounters counters_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  ///< last: begins when all else stands
};

}  // namespace heel::sim
