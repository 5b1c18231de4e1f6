// Textured triangles and parallelograms drawn through a table of rays, so that lens distortion is exact.
//
// A face is P(u, v) = P0 + u (P1 − P0) + v (P2 − P0) in the camera frame. A pixel's ray r meets it at depth z
// where (u, v, 1)/z = M⁻¹ r with M = [P1−P0, P2−P0, P0] (M. Olano and T. Greer, "Triangle scan conversion
// using 2D homogeneous coordinates", 1997). Everything is a dot product with r, and nothing needs near-plane
// clipping but the search window.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "heel-sim/camera/ray_table.h"
#include "heel-sim/world/texture.h"

namespace heel::sim {

struct Corner {
  Eigen::Vector3f position_m;  ///< camera frame
  float s_texel = 0.f;         ///< texture coordinates of level 0
  float t_texel = 0.f;
  float light = 1.f;  ///< irradiance: a white texel shows as 255 · light at exposure 1
};

enum class FaceShape : std::uint8_t { Triangle, Parallelogram };

struct Face {
  FaceShape shape = FaceShape::Triangle;
  std::array<Corner, 3> corners;  ///< a parallelogram's fourth corner is P1 + P2 − P0
  const Texture* texture = nullptr;
  float texels_per_m = 1.f;
  int body = 0;  ///< which rigid body it belongs to (motion blur, truth)
  bool two_sided = false;
};

class Rasteriser {
 public:
  explicit Rasteriser(const RayTable& rays);

  void clear();
  /// Draws one face into the depth buffer. Front faces are counter-clockwise when seen from outside
  /// (right-handed: (P1−P0) × (P2−P0) points towards the camera); back faces are dropped unless two-sided.
  void draw(const Face& face);
  /// Radiance of every pixel, 0 … 255 · light; pixels nothing covers keep `background`.
  void shade(float background, std::vector<float>& radiance) const;

  /// 1/z of the nearest surface, 0 where there is none.
  float inverse_depth(int x_px, int y_px) const { return inverse_depth_[index(x_px, y_px)]; }
  /// The body seen at a pixel, −1 where there is none.
  int body(int x_px, int y_px) const;

 private:
  using Row = std::array<float, 3>;  ///< coefficients of a linear form of the ray (x, y, 1)

  struct Window {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< [x0, x1) × [y0, y1)
    bool empty() const { return x0 >= x1 || y0 >= y1; }
  };
  struct Prepared {
    Row u{}, v{}, w{};       ///< u/z, v/z, 1/z
    Row s{}, t{};            ///< texture coordinates / z
    Row light{};             ///< light / z
    float footprint2 = 0.f;  ///< (texels a pixel)² = footprint2 / w³ on the optical axis
    const Texture* texture = nullptr;
    int body = 0;
  };

  std::size_t index(int x_px, int y_px) const { return static_cast<std::size_t>(y_px) * width_ + x_px; }
  Window window_of(const Face& face) const;
  template <FaceShape kShape>
  void fill(const Prepared& face, std::int32_t id, const Window& window);
  void shade_run(const Prepared& face, std::size_t first, int count, float* out) const;

  const RayTable& rays_;
  int width_;
  int height_;
  std::vector<float> inverse_depth_;
  std::vector<std::int32_t> face_id_;
  std::vector<Prepared> faces_;
};

}  // namespace heel::sim
