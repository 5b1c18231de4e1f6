// Draws textured triangles and parallelograms through a table of rays, so that lens distortion is exact.
//
// A face is P(u, v) = P0 + u (P1 − P0) + v (P2 − P0) in the camera frame. A pixel's ray r meets it at depth z
// where (u, v, 1)/z = M⁻¹ r with M = [P1−P0, P2−P0, P0] (M. Olano and T. Greer, "Triangle scan conversion
// using 2D homogeneous coordinates", 1997). All values are dot products with r, and only the search window
// needs clipping at the near plane.
//
// Rolling shutter: a row is exposed earlier or later than the middle one, and the corners move meanwhile. M⁻¹
// of the first and the last row are interpolated linearly by row, which is right to 0.02 px at half a radian
// a second and 30 ms of readout.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/render/ray_table.h"
#include "sim/render/texture.h"
#include "sim/render/thread_pool.h"

namespace heel::sim {

struct Corner {
  Eigen::Vector3f position_m;  ///< camera frame, when the middle row is exposed
  float s_texel = 0.f;         ///< texture coordinates of level 0
  float t_texel = 0.f;
  float light = 1.f;  ///< irradiance: a white texel has radiance 255 · light
  Eigen::Vector3f shift_m{0.f, 0.f,
                          0.f};  ///< motion from the first row's exposure to the last's, camera frame
};

enum class FaceShape : std::uint8_t { Triangle, Parallelogram };

/// The texture of a face, and the rigid body that the face belongs to.
struct Surface {
  const Texture* texture = nullptr;
  float texels_per_m = 1.f;
  int body = 0;  ///< for motion blur
};

class Rasteriser {
 public:
  /// `workers` process the rows in parallel.
  Rasteriser(const RayTable& rays, ThreadPool& workers);

  void clear();
  /// Adds a face to the next draw(). Front faces are counter-clockwise when seen from outside: (P1−P0) ×
  /// (P2−P0) points towards the camera. Back faces are left out. A parallelogram's fourth corner is P1 + P2 −
  /// P0.
  void add(FaceShape shape, const std::array<Corner, 3>& corners, const Surface& surface);
  /// Adds small triangles with shared corners. The picture is that of `add` for each, but it is faster.
  void add_mesh(std::span<const Corner> corners, std::span<const std::array<int, 3>> triangles,
                const Surface& surface);
  /// Finds the nearest face of every pixel and its radiance, 0 … 255 · light. Pixels without a face get
  /// `background`.
  void draw(float background, std::vector<float>& radiance);

  /// 1/z of the nearest surface, 0 where there is none. Valid after draw().
  float inverse_depth(int x_px, int y_px) const { return inverse_depth_[index(x_px, y_px)]; }
  /// The body visible at a pixel, −1 where there is none. Valid after draw().
  int body(int x_px, int y_px) const;

 private:
  using RayForm = std::array<float, 3>;  ///< coefficients of a linear form of the ray (x, y, 1)
  /// A linear form that changes linearly from row to row: `middle` + (y − middle row) · `per_row`.
  struct RowwiseForm {
    RayForm middle{}, per_row{};
    RayForm at(float rows_below_middle) const;
  };
  struct Window {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< [x0, x1) × [y0, y1)
    bool empty() const { return x0 >= x1 || y0 >= y1; }
  };
  struct Face {
    RowwiseForm u, v, w;      ///< u/z, v/z, 1/z
    RowwiseForm s, t, light;  ///< texture coordinates / z, light / z
    float footprint2 = 0.f;   ///< (texels per pixel)² = footprint2 / w³ on the optical axis
    FaceShape shape = FaceShape::Triangle;
    Window window;
    Surface surface;
  };
  /// The pixels that a corner passes during the readout; not `inside` when it may leave the picture.
  struct CornerPixels {
    bool inside = false;
    float x_low = 0.f, x_high = 0.f, y_low = 0.f, y_high = 0.f;
  };

  std::size_t index(int x_px, int y_px) const { return static_cast<std::size_t>(y_px) * width_ + x_px; }
  float rows_below_middle(int y_px) const {
    return static_cast<float>(y_px) - 0.5f * static_cast<float>(height_ - 1);
  }
  bool faces_camera(const std::array<Corner, 3>& corners) const;
  CornerPixels pixels_of(const Corner& corner) const;
  Window window_of(FaceShape shape, const std::array<Corner, 3>& corners) const;
  Window clamped(double x_low, double x_high, double y_low, double y_high) const;
  void add_in_window(FaceShape shape, const std::array<Corner, 3>& corners, const Surface& surface,
                     const Window& window);
  template <FaceShape kShape>
  void find_pixels(const Face& face, std::int32_t id, int y_begin, int y_end);
  void shade_row(int y, float background, float* out) const;
  void shade_run(const Face& face, int x, int y, int count, float* out) const;

  const RayTable& rays_;
  ThreadPool& workers_;
  int width_;
  int height_;
  std::vector<float> inverse_depth_;
  std::vector<std::int32_t> face_id_;
  std::vector<Face> faces_;
  std::vector<CornerPixels> corner_pixels_;  ///< of the mesh being added
};

}  // namespace heel::sim
