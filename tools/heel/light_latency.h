// From a light that is switched to the command that would follow: through the real camera and vision, at the
// configured rate of control and of the robot's line. Nothing is sent to the robot.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/config.h"
#include "evaluation/reports/latency_figures.h"

namespace heel::cli {

struct LightFigures {
  std::string camera;        ///< what the source says of itself
  std::size_t switches = 0;  ///< of the light
  std::size_t seen = 0;      ///< of them, those that a frame has shown
  std::size_t tiles = 0;     ///< parts of the picture that follow the light, of evaluation::TileLevels
  double contrast = 0.0;     ///< grey levels
  std::string no_vision;     ///< why vision is not included; empty: it is
  double period_ms = 0.0;    ///< of control
  /// Light to the camera's stamp, to dequeued, to vision's end (where it is included), to the tick, to
  /// the command's last byte on the robot's line (not over TCP).
  std::vector<evaluation::LatencyHop> hops;
  evaluation::LatencyHop to_dequeued;  ///< from the light: what the camera, its cable and driver take
  evaluation::LatencyHop total;        ///< from the light to the end of the last hop
};

/// Switches the light `switches` times, at random moments, while the camera runs. Throws heel::Error when the
/// camera or the light cannot be used, or the pictures do not follow the light.
LightFigures measure_light(const Config& config, const std::string& lamp, int switches);

}  // namespace heel::cli
