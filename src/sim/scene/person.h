// A person: a torso in a printed shirt, head, hair, swinging arms and legs, moved by the gait.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/scene/body_parts.h"
#include "sim/scene/detail.h"
#include "sim/scene/mesh.h"
#include "sim/scene/shirts.h"
#include "sim/scene/torso.h"
#include "sim/scene/walk.h"

namespace heel::sim {

struct PersonSettings {
  ShirtDesign shirt = ShirtDesign::Bold;
  Hair hair = Hair::Short;
  double depth = 1.0;  ///< from chest to back, beside the usual body: a flat back 0.75, a round one 1.3
  double sway_yaw_rad = 0.09;  ///< the back turns this far either way with each stride (paper: within 10°)
  double sway_side_m = 0.02;
  double sway_roll_rad = 0.025;
  double bob_m = 0.012;
  double lean_rad = 0.03;         ///< forwards while walking
  double cloth_ripple_m = 0.003;  ///< folds that run over the shirt with the gait
  double cloth_slide_m = 0.003;   ///< how far the cloth slides over the back with each stride
  double breath_m = 0.002;        ///< how far the back comes out with each breath
};

/// Bodies move rigidly, but for the cloth of the torso.
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

struct PersonPose {
  WalkState walk;
  std::array<Eigen::Isometry3d, kPersonParts> world_from_part;
  ClothState cloth;
};

class Person {
 public:
  /// `seed` is of the body, `shirt_seed` of the print: two with the same print wear the same shirt.
  /// Without pictures the surfaces bear no texture.
  Person(const PersonSettings& settings, std::uint64_t seed, std::uint64_t shirt_seed,
         Detail detail = Detail::Pictures);
  Person(const Person&) = delete;  // meshes point at the textures
  Person(Person&&) = default;

  /// `clock_s` runs always (breathing), the walk only while walking.
  PersonPose pose(const WalkState& walk, double clock_s) const;

  /// A part's surface in its own frame; the torso's with its cloth at rest.
  const Mesh& mesh(PersonPart part) const { return meshes_[static_cast<std::size_t>(part)]; }
  const Torso& torso() const { return torso_; }

  /// Middle of the back on the bare surface, torso frame: the point the truth speaks of.
  Eigen::Vector3d back_centre_m() const { return torso_.back_centre_m(); }
  /// A point of the shirt by its cloth coordinates (texels), on the tessellated surface, torso frame.
  Eigen::Vector3d shirt_point_m(double s_texel, double t_texel, const ClothState& cloth = {}) const {
    return torso_.shirt_point_m(s_texel, t_texel, cloth);
  }

 private:
  PersonSettings settings_;
  Torso torso_;
  std::vector<Texture> textures_;
  std::array<Mesh, kPersonParts> meshes_;
};

/// Nothing of a person is farther from the axis through their feet than this, nor higher.
inline constexpr double kPersonReachM = 0.75;
inline constexpr double kPersonHeightM = 1.85;
/// What a sonar hears and a bumper meets of a person.
inline constexpr double kPersonRadiusM = 0.22;

}  // namespace heel::sim
