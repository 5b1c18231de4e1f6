// The person: a curved torso in a printed shirt, head, swinging arms and legs, moved by the gait.
// Torso frame: x forwards, y to the person's left, z up; origin at the hips.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "heel-sim/world/mesh.h"
#include "heel-sim/world/shirts.h"
#include "heel-sim/world/walk.h"

namespace heel::sim {

struct PersonSettings {
  ShirtDesign shirt = ShirtDesign::Bold;
  double sway_yaw_rad = 0.09;  ///< the back turns this far either way with each stride (paper: within 10°)
  double sway_side_m = 0.02;
  double sway_roll_rad = 0.025;
  double bob_m = 0.012;
  double lean_rad = 0.03;         ///< forwards while walking
  double cloth_ripple_m = 0.003;  ///< folds that run over the shirt with the gait
};

/// Bodies move rigidly, but for the ripple of the shirt.
enum PersonPart : int { kTorso, kHead, kLeftArm, kRightArm, kLeftLeg, kRightLeg, kPersonParts };

struct PersonPose {
  WalkState walk;
  std::array<Eigen::Isometry3d, kPersonParts> world_from_part;
  double ripple_rad = 0.0;  ///< phase of the shirt's folds
};

class Person {
 public:
  Person(const PersonSettings& settings, std::uint64_t seed);

  /// `clock_s` runs always (breathing), the walk only while walking.
  PersonPose pose(const WalkState& walk, double clock_s) const;

  /// The part's surface in its own frame, folds and breath included.
  const Mesh& mesh(PersonPart part) const { return meshes_[static_cast<std::size_t>(part)]; }
  Mesh torso_mesh(const PersonPose& pose) const;

  /// Middle of the back on the bare surface, torso frame: the point the truth speaks of.
  Eigen::Vector3d back_centre_m() const;
  /// A point of the shirt by its cloth coordinates (texels), on the tessellated surface, torso frame.
  Eigen::Vector3d shirt_point_m(double s_texel, double t_texel) const;

 private:
  PersonSettings settings_;
  std::vector<Texture> textures_;
  std::array<Mesh, kPersonParts> meshes_;
};

}  // namespace heel::sim
