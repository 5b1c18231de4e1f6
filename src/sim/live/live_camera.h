// The simulated camera in real time: a thread of its own draws what the robot's camera sees and hands each
// frame to a sink. Drawing never delays the robot: the two threads share one small record, locked only while
// it is copied.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/picture_turn.h"
#include "sim/live/frame_sink.h"
#include "sim/robot/p3at.h"
#include "sim/scene/world.h"

namespace heel::sim {

/// The robot's last known motion, written by the robot's thread and read by the camera's.
class SharedMotion {
 public:
  void set(const RobotTruth& truth);
  /// The last record extrapolated to `t_ns` at constant speed.
  RobotMotion at(TimeNs t_ns) const;

 private:
  mutable std::mutex mutex_;
  RobotTruth truth_;
};

struct LiveCameraCounters {
  std::uint64_t frames = 0;
  std::uint64_t frames_late = 0;     ///< left out: drawing was not fast enough
  std::uint64_t frames_dropped = 0;  ///< left out: the scenario's drop_share
  double draw_ms_mean = 0.0;
  double draw_ms_max = 0.0;
};

/// Opens where the frames go. Throws heel::Error.
using OpenSink = std::function<std::unique_ptr<FrameSink>()>;

class LiveCamera {
 public:
  /// Frames begin at `t_start_ns` (CLOCK_MONOTONIC), which is time 0 of world and robot. A frame every
  /// `saved_every_s` is also saved in `saved_folder` (none when empty). Throws heel::Error when the folder
  /// cannot be made. A sink that fails later ends the camera with a line on stderr; the robot goes on.
  LiveCamera(World& world, const SharedMotion& motion, OpenSink open_sink, TimeNs t_start_ns,
             const std::string& saved_folder, double saved_every_s);
  ~LiveCamera();
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  LiveCameraCounters counters() const;
  /// From now on, for so long, readers find no camera.
  void take_away(TimeNs duration_ns);

 private:
  void run();
  void draw(std::uint64_t sequence, TimeNs t_ns);
  void save(std::uint64_t sequence, TimeNs t_ns);
  TimeNs readable_ns(TimeNs t_ns) const;
  std::uint64_t current_sequence() const;

  World& world_;
  const SharedMotion& motion_;
  PictureTurner turner_;  ///< upright → as the camera sends it
  OpenSink open_sink_;
  std::unique_ptr<FrameSink> sink_;  ///< null while the camera is away
  TimeNs t_start_ns_;
  TimeNs period_ns_;
  std::string saved_folder_;
  TimeNs saved_every_ns_;
  TimeNs t_next_save_ns_;
  std::vector<std::uint8_t> grey_;
  mutable std::mutex counters_mutex_;
  LiveCameraCounters counters_;
  std::atomic<bool> stop_{false};
  std::atomic<TimeNs> t_back_ns_{0};  ///< until then the camera is away; CLOCK_MONOTONIC
  std::thread thread_;                ///< last: it starts when every other member is ready
};

}  // namespace heel::sim
