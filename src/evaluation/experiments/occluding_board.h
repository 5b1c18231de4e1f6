// A board between camera and person, drawn over a finished picture: an occlusion of known share.
#pragma once

#include <cstdint>
#include <vector>

#include "heel/camera_model.h"
#include "sim/scene/world.h"

namespace heel::evaluation {

// Half the size of the part of the back that a template shows.
inline constexpr double kBackHalfWidth_m = 0.16;
inline constexpr double kBackHalfHeight_m = 0.26;

/// Hides `share` (0…1) of the back's width, from its left edge in the picture; negative: from its right edge.
/// The board is higher than the back, has a pattern drawn from `seed` and the same light as the room.
void draw_occluding_board(const sim::Truth& truth, const CameraModel& camera, double share,
                          std::uint64_t seed, double light, std::vector<std::uint8_t>& grey);

}  // namespace heel::evaluation
