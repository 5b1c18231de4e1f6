// A board between camera and person, laid over a finished picture: occlusion whose share is known.
#pragma once

#include <cstdint>
#include <vector>

#include "heel/camera_model.h"
#include "sim/scene/world.h"

namespace heel::evaluation {

inline constexpr double kBackHalfWidth_m = 0.16;   ///< of what a template shows
inline constexpr double kBackHalfHeight_m = 0.26;  ///< likewise

/// Hides `share` (0…1) of the back's width, from its left edge in the picture; negative: from its right edge.
/// The board reaches beyond the back above and below and is printed with a pattern of its own, by `seed`, lit
/// like the room.
void draw_board(const sim::Truth& truth, const CameraModel& camera, double share, std::uint64_t seed,
                double light, std::vector<std::uint8_t>& grey);

}  // namespace heel::evaluation
