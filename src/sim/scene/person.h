// A person: torso in a printed shirt, head, hair, arms and legs, all moved by the gait.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/scene/body_parts.h"
#include "sim/scene/mesh.h"
#include "sim/scene/shirts.h"
#include "sim/scene/torso.h"
#include "sim/scene/walk.h"
#include "sim/scene/world_use.h"

namespace heel::sim {

struct PersonSettings {
  ShirtDesign shirt = ShirtDesign::Bold;
  Hair hair = Hair::Short;
  double depth =
      1.0;  ///< from chest to back, relative to the average body: 0.75 has a flat back, 1.3 a round one
  TorsoShape torso = TorsoShape::Body;
  double sway_yaw_rad = 0.044;  ///< the chest turns this far to each side with each stride
  double hips_yaw_rad = 0.157;  ///< and the hips this far, the other way
  double sway_side_m = 0.02;
  double sway_roll_rad = 0.1;
  double bob_m = 0.012;
  double lean_rad = 0.03;       ///< forwards while walking
  double cloth_fold_m = 0.005;  ///< standard deviation of the shirt's folds while the person stands
  double cloth_fold_walking_m = 0.008;
  double cloth_pull_walking_m =
      0.018;                     ///< and of the whole shirt's slow displacements, at the corners of the back
  double cloth_slide_m = 0.003;  ///< how far the cloth slides over the back with each stride
  double breath_m = 0.002;       ///< how far the back moves outwards with each breath
};

/// The parts are rigid bodies, except for the cloth of the torso.
enum PersonPart : int {
  kTorso,
  kHead,
  kHair,
  kLeftArm,
  kRightArm,
  kLeftThigh,
  kRightThigh,
  kLeftShin,
  kRightShin,
  kPersonParts
};

/// How a standing person differs from the upright one.
struct Posture {
  std::uint64_t settling = 1;  ///< of the cloth
  double lean_rad = 0.0;       ///< forwards
  double roll_rad = 0.0;       ///< to the person's right
  double turn_rad = 0.0;       ///< of the chest against the walking direction, to the left
  double twist_rad = 0.0;      ///< of the hips against the chest, to the left
};

/// The posture of the reference view: nobody's cloth settles in the same way twice.
inline constexpr Posture kTaughtPosture{.settling = 0};

struct PersonPose {
  WalkState walk;
  std::array<Eigen::Isometry3d, kPersonParts> world_from_part;
  ClothState cloth;
  Eigen::Vector3d hips_forwards{1, 0, 0};  ///< world frame
};

class Person {
 public:
  /// `seed` determines the body, `shirt_seed` the print of the shirt. With WorldUse::TruthOnly there are no
  /// textures and no meshes but the torso's.
  Person(const PersonSettings& settings, std::uint64_t seed, std::uint64_t shirt_seed,
         WorldUse use = WorldUse::Rendering);
  Person(const Person&) = delete;  // meshes point at the textures
  Person(Person&&) = default;

  /// `clock_s` is the world's time, for breathing.
  PersonPose pose(const WalkState& walk, double clock_s, const Posture& posture = {}) const;

  /// A part's surface in its own frame; the torso's with its cloth at rest.
  const Mesh& mesh(PersonPart part) const { return meshes_[static_cast<std::size_t>(part)]; }
  const Torso& torso() const { return torso_; }

  /// Middle of the back on the surface without cloth, torso frame.
  Eigen::Vector3d back_centre_m() const { return torso_.back_centre_m(); }
  /// The point of the shirt at texture coordinates (s, t), on the triangles of the surface, torso frame.
  Eigen::Vector3d shirt_point_m(double s_texel, double t_texel, const ClothState& cloth = {}) const {
    return torso_.shirt_point_m(s_texel, t_texel, cloth);
  }

 private:
  PersonSettings settings_;
  Torso torso_;
  std::vector<Texture> textures_;
  std::array<Mesh, kPersonParts> meshes_;
};

/// Bounds of a person: the largest distance from the vertical axis through the feet, and the height.
inline constexpr double kPersonReach_m = 0.75;
inline constexpr double kPersonHeight_m = 1.85;
/// The person's radius for sonars and bumpers.
inline constexpr double kPersonRadius_m = 0.22;

}  // namespace heel::sim
