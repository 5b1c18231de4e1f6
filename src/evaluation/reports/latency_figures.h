// Where the time goes between the exposure of a frame and the command that it leads to, from a recording.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

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
  /// of that tick's command.
  std::vector<LatencyHop> hops;
  LatencyHop total;             ///< from the capture to the last byte
  LatencyHop dequeued_to_last;  ///< what heeld itself adds
  /// The slowest command's stamps after its capture, in the order of the hops.
  std::vector<double> slowest_ms;
};

/// Throws heel::Error when it cannot be read, or has no stamps of frames.
LatencyFigures latency_of(const std::string& recording);

}  // namespace heel::evaluation
