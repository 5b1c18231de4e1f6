// Synthetic images in grey levels 0…255, and their view as a frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "heel/flow.h"

namespace heel::test {

struct TestImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> grey;

  TestImage(int width, int height, std::uint8_t level = 128)
      : width_px(width), height_px(height), grey(static_cast<std::size_t>(width * height), level) {}

  std::uint8_t& at(int x, int y) { return grey[static_cast<std::size_t>(y * width_px + x)]; }
  std::uint8_t at(int x, int y) const { return grey[static_cast<std::size_t>(y * width_px + x)]; }

  FrameView view() const {
    FrameView frame;
    frame.header.width_px = static_cast<std::uint32_t>(width_px);
    frame.header.height_px = static_cast<std::uint32_t>(height_px);
    frame.grey = grey.data();
    frame.stride_bytes = static_cast<std::uint32_t>(width_px);
    return frame;
  }
};

/// Sets every pixel to level(x, y), rounded and clamped; x and y are pixel centres.
template <typename Level>
TestImage image_of(int width, int height, Level level) {
  TestImage image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      image.at(x, y) =
          static_cast<std::uint8_t>(std::clamp(std::lround(level(double(x), double(y))), 0L, 255L));
  }
  return image;
}

/// A Gaussian blob; positive amplitude is light on dark.
struct Blob {
  double x_px, y_px, sigma_px, amplitude;
  double operator()(double x, double y) const {
    const double r2 = (x - x_px) * (x - x_px) + (y - y_px) * (y - y_px);
    return amplitude * std::exp(-r2 / (2.0 * sigma_px * sigma_px));
  }
};

inline TestImage noise_image(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  TestImage image(width, height);
  for (auto& grey : image.grey) grey = static_cast<std::uint8_t>(random() >> 24);
  return image;
}

/// Blobs of many sizes and both signs: texture with features at every scale. It is a function of position, so
/// that it can be sampled through any geometric transformation.
class BlobField {
 public:
  BlobField(int width, int height, int count, unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double from, double to) {
      return from + (to - from) * static_cast<double>(random()) / 4294967296.0;
    };
    for (int i = 0; i < count; ++i) {
      const double sigma_px = 1.5 * std::pow(4.0, uniform(0.0, 1.0));
      blobs_.push_back(
          {uniform(0, width), uniform(0, height), sigma_px, (i % 2 != 0 ? 1.0 : -1.0) * uniform(30.0, 80.0)});
    }
  }
  double operator()(double x, double y) const {
    double level = 128.0;
    for (const Blob& blob : blobs_) {
      const double reach = 5.0 * blob.sigma_px;
      if (std::abs(x - blob.x_px) < reach && std::abs(y - blob.y_px) < reach) level += blob(x, y);
    }
    return level;
  }

 private:
  std::vector<Blob> blobs_;
};

}  // namespace heel::test
