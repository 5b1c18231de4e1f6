#include "vision/reach/grey_texture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace heel {
namespace {

constexpr int kCells_px[] = {6, 12, 24, 48, 96, 192};  // distance of the random values, an octave each

/// Adds random values `cell_px` apart, bilinear between them.
void add_octave(int width_px, int height_px, int cell_px, std::mt19937& random, std::vector<float>& sum) {
  const int columns = width_px / cell_px + 2, rows = height_px / cell_px + 2;
  std::vector<float> values(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::normal_distribution<float> normal;
  for (float& value : values) value = normal(random);
  for (int y = 0; y < height_px; ++y) {
    const float fy = static_cast<float>(y % cell_px) / static_cast<float>(cell_px);
    const float* upper = &values[static_cast<std::size_t>(y / cell_px) * static_cast<std::size_t>(columns)];
    const float* lower = upper + columns;
    float* out = &sum[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px)];
    for (int x = 0; x < width_px; ++x) {
      const int i = x / cell_px;
      const float fx = static_cast<float>(x % cell_px) / static_cast<float>(cell_px);
      const float above = upper[i] + fx * (upper[i + 1] - upper[i]);
      const float below = lower[i] + fx * (lower[i + 1] - lower[i]);
      out[x] += above + fy * (below - above);
    }
  }
}

}  // namespace

std::vector<float> grey_texture(int width_px, int height_px, std::uint32_t seed) {
  std::vector<float> texture(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), 0.f);
  std::mt19937 random(seed);
  for (const int cell_px : kCells_px) add_octave(width_px, height_px, cell_px, random, texture);
  double sum = 0.0, squares = 0.0;
  for (const float value : texture) {
    sum += static_cast<double>(value);
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  const double count = static_cast<double>(std::max<std::size_t>(texture.size(), 1));
  const double mean = sum / count;
  const double deviation = std::sqrt(std::max(squares / count - mean * mean, 1e-12));
  for (float& value : texture) value = static_cast<float>((static_cast<double>(value) - mean) / deviation);
  return texture;
}

}  // namespace heel
