#include "heel-sim/camera/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "heel-sim/world/random.h"

namespace heel::sim {
namespace {

constexpr int kPad = 8;               ///< pixels repeated around the picture
constexpr float kMotionMaxPx = 10.f;  ///< longest blur drawn: kernel radius 7 < kPad
constexpr int kMotionStepsPx = 4;     ///< quantisation of blur vectors, per pixel
constexpr int kMotionBins = 2 * static_cast<int>(kMotionMaxPx) * kMotionStepsPx + 1;
constexpr std::size_t kNoiseSamples = 1 << 16;

int motion_bin(float d_px) {
  const float clamped = std::clamp(d_px, -kMotionMaxPx, kMotionMaxPx);
  return static_cast<int>(std::lround(clamped * kMotionStepsPx)) + (kMotionBins - 1) / 2;
}

float motion_of_bin(int bin) {
  return static_cast<float>(bin - (kMotionBins - 1) / 2) / static_cast<float>(kMotionStepsPx);
}

}  // namespace

Sensor::Sensor(const RayTable& rays, const SensorSettings& settings, std::uint64_t seed)
    : width_(rays.camera.width_px),
      height_(rays.camera.height_px),
      padded_stride_(width_ + 2 * kPad),
      settings_(settings),
      seed_(seed),
      padded_(static_cast<std::size_t>(padded_stride_) * (height_ + 2 * kPad)),
      blurred_(rays.x.size()),
      kernels_(static_cast<std::size_t>(kMotionBins) * kMotionBins) {
  // cos⁴-like fall-off, scaled so that the corner loses the stated share.
  const double corner2 =
      0.25 * (static_cast<double>(width_) * width_ + static_cast<double>(height_) * height_);
  vignette_.reserve(rays.x.size());
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const double dx = x - 0.5 * (width_ - 1);
      const double dy = y - 0.5 * (height_ - 1);
      const double share = 1.0 - settings.vignetting * (dx * dx + dy * dy) / corner2;
      vignette_.push_back(static_cast<float>(settings.gain * share));
    }
  }
  Random random(derived_seed(seed, 0x5e));
  noise_.reserve(kNoiseSamples + static_cast<std::size_t>(width_));
  for (std::size_t i = 0; i < kNoiseSamples; ++i) noise_.push_back(static_cast<float>(random.normal()));
  for (int i = 0; i < width_; ++i) noise_.push_back(noise_[static_cast<std::size_t>(i)]);
  for (int grey = 0; grey < 256; ++grey) {
    const double shot2 = settings.shot_noise_grey * settings.shot_noise_grey * grey / 128.0;
    sigma_grey_.push_back(
        static_cast<float>(std::sqrt(settings.read_noise_grey * settings.read_noise_grey + shot2)));
  }
}

void Sensor::pad(const std::vector<float>& radiance) {
  for (int y = -kPad; y < height_ + kPad; ++y) {
    const float* from = radiance.data() + static_cast<std::size_t>(std::clamp(y, 0, height_ - 1)) * width_;
    float* to = padded_.data() + static_cast<std::size_t>(y + kPad) * padded_stride_;
    std::fill_n(to, kPad, from[0]);
    std::copy_n(from, width_, to + kPad);
    std::fill_n(to + kPad + width_, kPad, from[width_ - 1]);
  }
}

/// The lens's Gaussian swept along the motion vector, sampled at whole pixels, weights summing to one.
const std::vector<Sensor::Tap>& Sensor::kernel(float dx_px, float dy_px) {
  const int bin_x = motion_bin(dx_px);
  const int bin_y = motion_bin(dy_px);
  std::vector<Tap>& taps = kernels_[static_cast<std::size_t>(bin_y) * kMotionBins + bin_x];
  if (!taps.empty()) return taps;
  const float mx = motion_of_bin(bin_x);
  const float my = motion_of_bin(bin_y);
  const double sigma = std::max(settings_.blur_sigma_px, 0.05);
  const int steps = 1 + 4 * static_cast<int>(std::ceil(std::hypot(mx, my)));
  const int rx = std::min(kPad, static_cast<int>(std::ceil(std::abs(mx) / 2 + 2.5 * sigma)));
  const int ry = std::min(kPad, static_cast<int>(std::ceil(std::abs(my) / 2 + 2.5 * sigma)));
  double total = 0.0;
  for (int y = -ry; y <= ry; ++y) {
    for (int x = -rx; x <= rx; ++x) {
      double weight = 0.0;
      for (int k = 0; k < steps; ++k) {
        const double along = steps == 1 ? 0.0 : static_cast<double>(k) / (steps - 1) - 0.5;
        const double ex = (x - along * static_cast<double>(mx)) / sigma;
        const double ey = (y - along * static_cast<double>(my)) / sigma;
        weight += std::exp(-0.5 * (ex * ex + ey * ey));
      }
      if (weight / steps < 2e-3) continue;
      total += weight;
      taps.push_back({static_cast<std::ptrdiff_t>(y) * padded_stride_ + x, static_cast<float>(weight)});
    }
  }
  for (Tap& tap : taps) tap.weight = static_cast<float>(static_cast<double>(tap.weight) / total);
  return taps;
}

void Sensor::blur_block(int block_x, int block_y, const std::vector<Tap>& taps) {
  const int x0 = block_x * kMotionBlockPx;
  const int y_end = std::min(height_, (block_y + 1) * kMotionBlockPx);
  const int count = std::min(kMotionBlockPx, width_ - x0);
  for (int y = block_y * kMotionBlockPx; y < y_end; ++y) {
    std::array<float, kMotionBlockPx> sum{};
    // The padding makes reading a whole block safe at the right edge too.
    const float* from = padded_.data() + static_cast<std::size_t>(y + kPad) * padded_stride_ + kPad + x0;
    for (const Tap& tap : taps)
      for (int i = 0; i < kMotionBlockPx; ++i)
        sum[static_cast<std::size_t>(i)] += tap.weight * from[tap.offset + i];
    std::copy_n(sum.begin(), count, blurred_.begin() + static_cast<std::ptrdiff_t>(y) * width_ + x0);
  }
}

void Sensor::quantise(std::uint64_t frame, std::vector<std::uint8_t>& grey) const {
  grey.resize(blurred_.size());
  Random random(derived_seed(seed_, 0x100 + frame));
  for (int y = 0; y < height_; ++y) {
    const float* noise = noise_.data() + (random.next() & (kNoiseSamples - 1));
    const std::size_t row = static_cast<std::size_t>(y) * width_;
    for (int x = 0; x < width_; ++x) {
      const float light = std::clamp(blurred_[row + x] * vignette_[row + x], 0.f, 255.f);
      const float value = light + noise[x] * sigma_grey_[static_cast<std::size_t>(static_cast<int>(light))];
      grey[row + x] = static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.f, 255.f));
    }
  }
}

void Sensor::expose(const std::vector<float>& radiance, const MotionField& motion, std::uint64_t frame,
                    std::vector<std::uint8_t>& grey) {
  pad(radiance);
  for (int by = 0; by < motion.blocks_y; ++by) {
    for (int bx = 0; bx < motion.blocks_x; ++bx) {
      const auto block = static_cast<std::size_t>(by) * motion.blocks_x + bx;
      blur_block(bx, by, kernel(motion.dx_px[block], motion.dy_px[block]));
    }
  }
  quantise(frame, grey);
}

}  // namespace heel::sim
