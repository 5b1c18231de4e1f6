// The simulated camera in real time: a thread of its own draws what the robot's camera sees and hands it to
// readers of "sim:NAME". Drawing never holds up the robot: the two share one small record under a lock that
// nobody keeps for longer than a copy.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "capture/sim_channel.h"
#include "heel-sim/robot/p3at.h"
#include "heel-sim/world/world.h"

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
  /// `saved_every_s` one is kept in `saved_folder` (none when empty). Throws heel::Error when NAME is taken.
  LiveCamera(World& world, const SharedMotion& motion, const std::string& name, TimeNs t_start_ns,
             const std::string& saved_folder, double saved_every_s);
  ~LiveCamera();
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  LiveCameraCounters counters() const;

 private:
  void run();
  void draw(std::uint64_t sequence, TimeNs t_ns);
  TimeNs readable_ns(TimeNs t_ns) const;

  World& world_;
  const SharedMotion& motion_;
  SimChannelWriter channel_;
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

/// "sim:NAME" → NAME. Throws heel::Error on any other address.
std::string sim_camera_name(const std::string& address);

}  // namespace heel::sim
