// Mip-maps by averages of 2 × 2 texels, in float until each level is stored.
#include "sim/render/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "heel/error.h"

namespace heel::sim {
namespace {

Texture::Level quantised(const std::vector<float>& grey, int width, int height) {
  Texture::Level level;
  level.width_mask = width - 1;
  level.height_mask = height - 1;
  level.width_shift = std::countr_zero(static_cast<unsigned>(width));
  level.texels.reserve(grey.size());
  for (const float value : grey)
    level.texels.push_back(static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.f, 255.f)));
  return level;
}

std::vector<float> halved(const std::vector<float>& grey, int width, int height) {
  std::vector<float> out;
  out.reserve(grey.size() / 4);
  for (int y = 0; y < height; y += 2) {
    for (int x = 0; x < width; x += 2) {
      const float* p = &grey[static_cast<std::size_t>(y) * width + x];
      out.push_back(0.25f * (p[0] + p[1] + p[width] + p[width + 1]));
    }
  }
  return out;
}

}  // namespace

Canvas::Canvas(int width, int height, float grey)
    : width_(width), height_(height), grey_(static_cast<std::size_t>(width) * height, grey) {
  if (!std::has_single_bit(static_cast<unsigned>(width)) ||
      !std::has_single_bit(static_cast<unsigned>(height)))
    throw Error(fmt::format("texture: {} x {} texels (expected powers of two)", width, height));
}

void Canvas::blend(int x, int y, float grey, float coverage) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  float& texel = at(x, y);
  texel += (grey - texel) * std::clamp(coverage, 0.f, 1.f);
}

Texture::Texture(const Canvas& canvas) {
  int width = canvas.width();
  int height = canvas.height();
  std::vector<float> grey(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) grey[static_cast<std::size_t>(y) * width + x] = canvas.at(x, y);
  levels_.push_back(quantised(grey, width, height));
  while (width > 1 && height > 1) {
    grey = halved(grey, width, height);
    width /= 2;
    height /= 2;
    levels_.push_back(quantised(grey, width, height));
  }
}

}  // namespace heel::sim
