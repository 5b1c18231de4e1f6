// The torso in its shirt: a curved surface that breathes and twists, and cloth that folds and slides on it.
// Torso frame: x forwards, y to the person's left, z up; origin at the hips.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/scene/back_shape.h"
#include "sim/scene/cloth.h"
#include "sim/scene/mesh.h"

namespace heel::sim {

enum class TorsoShape : std::uint8_t {
  Body,
  Board,  ///< a flat, rigid board with the back of the shirt on it: for tests of the geometry
};

class Torso {
 public:
  /// `depth`: from chest to back, relative to the average body. `seed` determines the relief of the back and
  /// the folds of the shirt.
  Torso(TorsoShape shape, double depth, std::uint64_t seed);

  /// The surface with the cloth at rest.
  const Mesh& at_rest() const { return mesh_; }
  void set_texture(const Texture& texture) { mesh_.texture = &texture; }
  Mesh mesh(const ClothState& cloth) const;

  /// Middle of the back on the surface without cloth.
  Eigen::Vector3d back_centre_m() const;
  /// Where the cloth is whose place at rest is back_centre_m().
  Eigen::Vector3d back_centre_m(const ClothState& cloth) const;
  /// The point of the cloth at texture coordinates (s, t), on the triangles of the surface deformed by
  /// `cloth`.
  Eigen::Vector3d shirt_point_m(double s_texel, double t_texel, const ClothState& cloth) const;
  /// Points of the cloth spread over the part of the back that a template shows; the same points in the same
  /// order for every state.
  std::vector<Eigen::Vector3d> back_points_m(const ClothState& cloth) const;

 private:
  MeshVertex rest_vertex(double around, double s_texel, double z_m) const;
  MeshVertex shifted(const MeshVertex& rest, const ClothShift& shift, const ClothState& state) const;

  TorsoShape shape_;
  double depth_;
  BackShape back_;
  std::vector<double> around_;  ///< of the columns' edges
  Cloth cloth_;
  Mesh mesh_;
};

}  // namespace heel::sim
