// Where the time goes between the exposure of a frame and the command that it leads to, from a recording.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/reports/wheel_response.h"
#include "heel/time.h"

namespace heel::evaluation {

/// One way between two stamps.
struct LatencyHop {
  const char* name = "";  ///< "capture to dequeued"
  std::size_t count = 0;  ///< frames that have both stamps
  double p50_ms = 0.0, p99_ms = 0.0, max_ms = 0.0;
};

struct LatencyFigures {
  std::string file;
  std::size_t frames = 0;    ///< that vision has processed
  std::size_t commands = 0;  ///< of them, those that a written command has used
  double period_ms = 0.0;    ///< of control: the median time between ticks
  /// In order: capture to dequeued, to vision's start, to its end, to the tick that uses it, to the last byte
  /// of that tick's command; with the truth of a simulated robot, to its wheels.
  std::vector<LatencyHop> hops;
  LatencyHop total;                     ///< from the capture to the last byte
  LatencyHop dequeued_to_last;          ///< what heeld itself adds
  std::optional<LatencyHop> to_wheels;  ///< from the capture to the wheels, of commands that change the speed
  /// The slowest command's stamps after its capture, in the order of the hops.
  std::vector<double> slowest_ms;
};

/// `wheels`: of the same run; null: the way ends at the last byte. Throws heel::Error when the recording
/// cannot be read, or has no stamps of frames, and when no command of it is in the truth's time.
LatencyFigures latency_of(const std::string& recording, const WheelResponse* wheels = nullptr);

}  // namespace heel::evaluation
