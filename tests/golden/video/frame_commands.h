// Velocity commands on the wire, by the video's frames.
//
// A wire file has a line for each piece sent: "seconds hex". A recording's poses.csv says when each frame was
// taken, by the same clock. Between two frames, time counts as a fraction of a frame.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace heel::test {

struct Velocity {
  double vel_mm_s = 0.0;
  double rvel_deg_s = 0.0;
};

/// VEL and RVEL of one tick.
struct SentVelocity {
  double t_s = 0.0;
  Velocity velocity;
};

/// By the video's frame number.
using FrameCommands = std::map<int, Velocity>;

/// Decodes a wire file. Throws std::runtime_error for a malformed line, or bytes that are not packets.
std::vector<SentVelocity> read_wire(const std::string& path);

/// Capture time to the video's frame.
class FrameClock {
 public:
  /// `first_frame` is the video's frame that poses.csv counts as `first_count`.
  FrameClock(const std::string& poses_csv, int first_frame, int first_count);

  /// 12.5 is halfway between frames 12 and 13. Before the first and after the last frame it continues at the
  /// frame rate.
  double frame_at(double t_s) const;
  std::size_t frames() const { return frames_.size(); }
  /// The median time from the capture of a frame to the end of its vision.
  double vision_latency_s() const;
  /// The greatest age of the newest frame that vision had finished.
  double oldest_view_s() const;
  /// Frames between the first and the last one that vision did not look at.
  int missing() const;

 private:
  struct Taken {
    double t_s = 0.0;
    double done_s = 0.0;
    int frame = 0;
  };
  std::vector<Taken> frames_;
};

/// The mean of the commands from each frame to the next: VEL and RVEL carry their rounding error forward, so
/// that single commands differ by one.
FrameCommands mean_by_frame(const std::vector<SentVelocity>& sent, const FrameClock& clock);

/// "frame VEL RVEL" in whole units, change points only; the last row is the last frame. `header` stays above.
std::string golden_text(const std::string& header, const FrameCommands& commands);
/// Every frame from the first row's to the last's. Lines that begin with # are skipped.
FrameCommands read_golden(const std::string& path);

}  // namespace heel::test
