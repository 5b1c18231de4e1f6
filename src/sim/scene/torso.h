// The torso in its shirt: a curved surface that breathes, and cloth that ripples and slides on it.
// Torso frame: x forwards, y to the person's left, z up; origin at the hips.
#pragma once

#include <Eigen/Core>

#include "sim/scene/mesh.h"

namespace heel::sim {

/// The state of the shirt at one moment.
struct ClothState {
  double ripple_m = 0.0;        ///< height of the folds
  double ripple_rad = 0.0;      ///< their phase
  double breath_m = 0.0;        ///< how far the ribs are moved outwards
  double slide_around_m = 0.0;  ///< how far the cloth has slid on the body, towards the person's right
  double slide_up_m = 0.0;
};

class Torso {
 public:
  /// `depth`: from chest to back, relative to the average body.
  explicit Torso(double depth);

  /// The surface with the cloth at rest.
  const Mesh& at_rest() const { return mesh_; }
  void set_texture(const Texture& texture) { mesh_.texture = &texture; }
  Mesh mesh(const ClothState& cloth) const;

  /// Middle of the back on the surface without cloth.
  Eigen::Vector3d back_centre_m() const;
  /// The point of the cloth at texture coordinates (s, t), on the triangles of the surface deformed by
  /// `cloth`.
  Eigen::Vector3d shirt_point_m(double s_texel, double t_texel, const ClothState& cloth) const;

 private:
  double depth_;
  Mesh mesh_;
};

}  // namespace heel::sim
