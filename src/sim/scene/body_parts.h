// The person's head, hair, arms and legs: rounded surfaces and their textures. The torso is in torso.cpp.
#pragma once

#include <cstdint>
#include <string>

#include "sim/render/texture.h"
#include "sim/scene/mesh.h"

namespace heel::sim {

enum class Hair : std::uint8_t {
  Short,
  Ponytail,  ///< swings in front of the collar
  Long,      ///< hides the back down to the shoulder blades
};
/// Throws heel::Error naming the known styles.
Hair hair_style(const std::string& name);

inline constexpr double kHairRootZ_m = 0.78;  ///< torso frame
inline constexpr double kThighLength_m = 0.43;

Mesh head_mesh();            ///< with the neck; torso frame
Mesh hair_mesh(Hair style);  ///< the hanging hair; origin kHairRootZ_m above the hips
Mesh arm_mesh();             ///< hanging down from the shoulder joint
Mesh thigh_mesh();           ///< hanging down from the hip joint
Mesh shin_mesh();            ///< hanging down from the knee, with the shoe

/// The grey levels of one person, drawn from the seed.
struct PersonGreys {
  float skin, hair, trousers, shoes;
};
PersonGreys random_greys(std::uint64_t seed);

/// Hair above the hairline, which is higher over the face; skin below.
Texture head_surface(const PersonGreys& greys, std::uint64_t seed);
Texture hair_surface(const PersonGreys& greys, std::uint64_t seed);
/// A short sleeve of the shirt's cloth, then skin.
Texture arm_surface(const PersonGreys& greys, const Canvas& shirt, std::uint64_t seed);
/// Trousers, and the shoe at the lower end.
Texture leg_surface(const PersonGreys& greys, std::uint64_t seed);

}  // namespace heel::sim
