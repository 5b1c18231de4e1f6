// The person's head, hair, arms and legs: rounded surfaces and what covers them. The torso, which the camera
// follows, is in torso.cpp.
#pragma once

#include <cstdint>
#include <string>

#include "sim/render/texture.h"
#include "sim/scene/mesh.h"

namespace heel::sim {

enum class Hair : std::uint8_t {
  Short,
  Ponytail,  ///< a tail that swings before the collar
  Long,      ///< covers the back down to the shoulder blades
};
/// Throws heel::Error naming the known ones.
Hair hair_style(const std::string& name);

inline constexpr double kHairRootZM = 0.78;  ///< torso frame
inline constexpr double kThighLength_m = 0.43;

Mesh head_mesh();            ///< with the neck; torso frame
Mesh hair_mesh(Hair style);  ///< what hangs; origin at kHairRootZM over the hips
Mesh arm_mesh();             ///< hanging down from the shoulder joint
Mesh thigh_mesh();           ///< hanging down from the hip joint
Mesh shin_mesh();            ///< hanging down from the knee, with the shoe

/// Grey levels of one person.
struct Tones {
  float skin, hair, trousers, shoes;
};
Tones draw_tones(std::uint64_t seed);

/// Hair down to the nape, higher over the face; skin beneath.
Texture head_surface(const Tones& tones, std::uint64_t seed);
Texture hair_surface(const Tones& tones, std::uint64_t seed);
/// A short sleeve of the shirt's cloth, then skin.
Texture arm_surface(const Tones& tones, const Canvas& shirt, std::uint64_t seed);
/// Trousers; the shoe at the lower end.
Texture leg_surface(const Tones& tones, std::uint64_t seed);

}  // namespace heel::sim
