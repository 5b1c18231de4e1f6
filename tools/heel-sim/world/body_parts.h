// The person's head, arms and legs: rounded surfaces and what covers them. The torso, which the camera
// follows, is in person.cpp.
#pragma once

#include <cstdint>

#include "heel-sim/world/mesh.h"
#include "heel-sim/world/texture.h"

namespace heel::sim {

Mesh head_mesh();  ///< with the neck; torso frame
Mesh arm_mesh();   ///< hanging down from the shoulder joint
Mesh leg_mesh();   ///< hanging down from the hip joint

Texture head_surface(std::uint64_t seed);  ///< hair down to the nape, higher over the face; skin beneath
Texture arm_surface(std::uint64_t seed);   ///< a short sleeve, then skin
Texture trousers_cloth(std::uint64_t seed);

}  // namespace heel::sim
