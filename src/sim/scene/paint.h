// Draws anti-aliased shapes on a canvas. A shape is a function that gives the signed distance in texels,
// negative inside.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.h"
#include "sim/render/texture.h"

namespace heel::sim {

struct Box2 {
  int x0, y0, x1, y1;  ///< [x0, x1) × [y0, y1)
};

/// Blends `grey` over the texels of `box` that the shape `distance(x, y)` covers, with the given opacity.
template <typename Distance>
void paint(Canvas& canvas, const Box2& box, float grey, const Distance& distance, float opacity = 1.f) {
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x)
      canvas.blend(x, y, grey, opacity * static_cast<float>(0.5 - distance(x, y)));
}

/// Adds normally distributed noise of standard deviation `strength` to every texel. Each row reads the noise
/// from another place of a table, because computing it for every texel would take most of the time to make a
/// world.
inline void add_grain(Canvas& canvas, double strength, Random& random) {
  constexpr std::size_t kSamples = 1 << 14;
  std::vector<float> normals(kSamples);
  for (float& normal : normals) normal = static_cast<float>(strength * random.normal());
  for (int y = 0; y < canvas.height(); ++y) {
    std::size_t at = random.next();
    for (int x = 0; x < canvas.width(); ++x) {
      float& texel = canvas.at(x, y);
      texel = std::clamp(texel + normals[at++ % kSamples], 3.f, 252.f);
    }
  }
}

inline Box2 box_around(double x, double y, double radius) {
  const int r = static_cast<int>(std::ceil(radius)) + 2;
  const int cx = static_cast<int>(std::lround(x));
  const int cy = static_cast<int>(std::lround(y));
  return {cx - r, cy - r, cx + r + 1, cy + r + 1};
}

/// std::hypot without its protection against overflow, which would take most of the drawing time.
inline double length(double x, double y) {
  return std::sqrt(x * x + y * y);
}

/// Signed distance to a rectangle with half sides (hx, hy) around the origin.
inline double rectangle_distance(double x, double y, double hx, double hy) {
  const double dx = std::abs(x) - hx;
  const double dy = std::abs(y) - hy;
  return length(std::max(dx, 0.0), std::max(dy, 0.0)) + std::min(std::max(dx, dy), 0.0);
}

}  // namespace heel::sim
