// How long a camera takes to show a light that is switched, from the moments of switching and from the
// brightness of each frame's tiles. Which part of the picture shows the light is found from the frames.
//
// Units: grey levels; times of CLOCK_MONOTONIC.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "heel/flow.h"

namespace heel::evaluation {

/// The mean grey levels of 32 × 24 equal parts of a picture, row by row.
inline constexpr std::size_t kTileColumns = 32, kTileRows = 24;
using TileLevels = std::array<float, kTileColumns * kTileRows>;
TileLevels tile_levels(const FrameView& frame);

struct LightFrame {
  TimeNs t_capture_ns = 0;   ///< the camera's stamp
  TimeNs t_dequeued_ns = 0;  ///< when the program had it
  TileLevels tiles{};
};

struct LightSwitch {
  TimeNs t_ns = 0;  ///< when the light had been switched
  bool on = false;
};

/// The first frame after a switch that shows at least half of the change.
struct LightSeen {
  std::size_t switched = 0;  ///< index of the switch
  std::size_t frame = 0;     ///< index of the frame
};

struct LightResponse {
  std::size_t tiles = 0;  ///< that follow the light
  double contrast = 0.0;  ///< on minus off, mean of these tiles
  std::vector<LightSeen> seen{};
};

/// Frames and switches in the order of time. Throws heel::Error when fewer than four tiles follow the light,
/// or no frame shows it switched off or on for long enough: by the last two fifths of the time between two
/// switches the picture must have settled.
LightResponse light_response(std::span<const LightFrame> frames, std::span<const LightSwitch> switches);

}  // namespace heel::evaluation
