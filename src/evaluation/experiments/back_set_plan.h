// Which pictures a test set of backs has: persons, prints, postures, rooms, distances and turns.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/scene/person.h"

namespace heel::evaluation {

/// A person, or the board, and how they stand in one picture.
struct BackPicture {
  std::string image;  ///< file name
  std::string kind;   ///< teach, static, calm, rigid, board or walk
  std::string build, print, pose, room;
  double t_s = 0.0;  ///< of a walk
  double distance_m = 0.0;
  double yaw_deg = 0.0;      ///< of the walking direction in the camera, as PoseEstimate::yaw_rad
  double bearing_deg = 0.0;  ///< of the person in the picture, to the right
  double heading_rad =
      0.0;  ///< in the room: the light comes from another side, and the background is another
  sim::Posture posture;
};

inline constexpr double kBackSetTeach_m = 1.5;  ///< distance of the taught pictures

/// The pictures of standing persons and of the board, world by world (same build, print and room together);
/// the taught picture of a build and print comes first.
std::vector<BackPicture> back_set_stills(std::uint64_t seed);

/// What the build is: the body's depth, the seed of its relief and cloth; kBoard is none.
inline constexpr const char* kBoardBuild = "board";
struct BackBuild {
  std::string name;
  double depth = 1.0;
};
const std::vector<BackBuild>& back_set_builds();

}  // namespace heel::evaluation
