// Surfaces of the world: rigid bodies of textured triangles, and parallelograms that do not move, with their
// light.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "sim/render/rasteriser.h"
#include "sim/render/texture.h"
#include "sim/scene/light.h"

namespace heel::sim {

struct MeshVertex {
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();  ///< body frame
  Eigen::Vector3f normal = Eigen::Vector3f::UnitX();     ///< outward
  float s_texel = 0.f;
  float t_texel = 0.f;
};

/// A curved surface; triangles are counter-clockwise seen from outside.
struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::array<int, 3>> triangles;
  const Texture* texture = nullptr;
  float texels_per_m = 1.f;
};

/// A flat piece of the room in the world frame; its light is computed once.
struct StaticFace {
  FaceShape shape = FaceShape::Parallelogram;
  std::array<Eigen::Vector3f, 3> corners_m;
  std::array<float, 3> s_texel{};
  std::array<float, 3> t_texel{};
  std::array<float, 3> light{};
  const Texture* texture = nullptr;
  float texels_per_m = 1.f;
};

/// A tube around the z axis with open ends. `ring(k, j)` gives the vertex of ring k (from the top) at segment
/// j.
template <typename Ring>
Mesh tube(int rings, int segments, const Ring& ring) {
  Mesh mesh;
  for (int k = 0; k < rings; ++k)
    for (int j = 0; j <= segments; ++j) mesh.vertices.push_back(ring(k, j));
  for (int k = 0; k + 1 < rings; ++k)
    for (int j = 0; j < segments; ++j) {
      const int a = k * (segments + 1) + j;
      const int b = a + segments + 1;
      mesh.triangles.push_back({a, b, a + 1});
      mesh.triangles.push_back({a + 1, b, b + 1});
    }
  return mesh;
}

}  // namespace heel::sim
