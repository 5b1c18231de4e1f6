#include "sim/render/sensor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"

namespace heel::sim {
namespace {

constexpr int kPad = 8;                ///< width of the border that repeats the outermost pixels
constexpr float kMotionMax_px = 10.f;  ///< longest blur: its kernel radius 7 is below kPad
constexpr int kMotionSteps_px = 4;     ///< quantisation steps of blur vectors per pixel
constexpr int kMotionBins = 2 * static_cast<int>(kMotionMax_px) * kMotionSteps_px + 1;
constexpr int kMiddleMotionBin = (kMotionBins - 1) / 2;
constexpr int kBandBlocks = 3;  ///< rows of blocks that a thread processes at a time
constexpr std::size_t kNoiseSamples = 1 << 16;

int motion_bin(float d_px) {
  const float clamped = std::clamp(d_px, -kMotionMax_px, kMotionMax_px);
  return static_cast<int>(std::lround(clamped * kMotionSteps_px)) + kMiddleMotionBin;
}

float motion_of_bin(int bin) {
  return static_cast<float>(bin - kMiddleMotionBin) / static_cast<float>(kMotionSteps_px);
}

}  // namespace

Sensor::Sensor(const RayTable& rays, const SensorSettings& settings, std::uint64_t seed, ThreadPool& workers)
    : workers_(workers),
      width_(rays.camera.width_px),
      height_(rays.camera.height_px),
      padded_stride_(width_ + 2 * kPad),
      settings_(settings),
      seed_(seed),
      padded_(static_cast<std::size_t>(padded_stride_) * (height_ + 2 * kPad)),
      blurred_(rays.x.size()),
      kernels_(static_cast<std::size_t>(kMotionBins) * kMotionBins) {
  // The light falls with the square of the radius, so that the corner loses the stated share.
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
  sigma_grey_.resize(256);
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

/// The lens's Gaussian moved along the motion vector, sampled at whole pixels; the weights add up to one.
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
  const int x0 = block_x * kMotionBlock_px;
  const int y_end = std::min(height_, (block_y + 1) * kMotionBlock_px);
  const int count = std::min(kMotionBlock_px, width_ - x0);
  for (int y = block_y * kMotionBlock_px; y < y_end; ++y) {
    std::array<float, kMotionBlock_px> sum{};
    // Because of the padding, a whole block can be read at the right edge too.
    const float* from = padded_.data() + static_cast<std::size_t>(y + kPad) * padded_stride_ + kPad + x0;
    for (const Tap& tap : taps)
      for (int i = 0; i < kMotionBlock_px; ++i)
        sum[static_cast<std::size_t>(i)] += tap.weight * from[tap.offset + i];
    std::copy_n(sum.begin(), count, blurred_.begin() + static_cast<std::ptrdiff_t>(y) * width_ + x0);
  }
}

/// Light of bright places scattered over the picture: a sum of two exponential tails, a short and a long one.
void Sensor::compute_glare(int blocks_x, int blocks_y, float brightness) {
  glare_columns_ = blocks_x;
  const auto blocks = static_cast<std::size_t>(blocks_x) * blocks_y;
  std::vector<float> bright(blocks, 0.f);
  for (int by = 0; by < blocks_y; ++by)
    for (int bx = 0; bx < blocks_x; ++bx) {
      const int x = std::min(bx * kMotionBlock_px + kMotionBlock_px / 2, width_ - 1);
      const int y = std::min(by * kMotionBlock_px + kMotionBlock_px / 2, height_ - 1);
      const float* row = blurred_.data() + static_cast<std::size_t>(y) * width_;
      bright[static_cast<std::size_t>(by) * blocks_x + bx] =
          brightness * 0.5f * (row[x] + row[std::max(0, x - kMotionBlock_px / 2)]);
    }
  glare_.assign(blocks, 0.f);
  // A first-order filter forwards and backwards, along rows and columns, makes an exponential tail.
  const auto add_tail = [&](std::vector<float> light, float decay, float share) {
    const auto run = [&](std::size_t first, std::size_t step, int count) {
      for (int i = 1; i < count; ++i)
        light[first + i * step] += decay * (light[first + (i - 1) * step] - light[first + i * step]);
      for (int i = count - 2; i >= 0; --i)
        light[first + i * step] += decay * (light[first + (i + 1) * step] - light[first + i * step]);
    };
    for (int by = 0; by < blocks_y; ++by) run(static_cast<std::size_t>(by) * blocks_x, 1, blocks_x);
    for (int bx = 0; bx < blocks_x; ++bx)
      run(static_cast<std::size_t>(bx), static_cast<std::size_t>(blocks_x), blocks_y);
    for (std::size_t i = 0; i < blocks; ++i) glare_[i] += share * light[i];
  };
  const auto glare = static_cast<float>(settings_.glare);
  add_tail(bright, 0.5f, 0.5f * glare);
  add_tail(bright, 0.87f, 0.5f * glare);
}

/// The glare at a pixel, interpolated between the centres of the blocks.
float Sensor::glare_at(int x, int y) const {
  const int rows = static_cast<int>(glare_.size()) / glare_columns_;
  const float u = (static_cast<float>(x) - 0.5f * (kMotionBlock_px - 1)) / kMotionBlock_px;
  const float v = (static_cast<float>(y) - 0.5f * (kMotionBlock_px - 1)) / kMotionBlock_px;
  const int j = std::clamp(static_cast<int>(std::floor(u)), 0, glare_columns_ - 2);
  const int i = std::clamp(static_cast<int>(std::floor(v)), 0, rows - 2);
  const float fu = std::clamp(u - static_cast<float>(j), 0.f, 1.f);
  const float fv = std::clamp(v - static_cast<float>(i), 0.f, 1.f);
  const float* top = glare_.data() + static_cast<std::size_t>(i) * glare_columns_ + j;
  const float* bottom = top + glare_columns_;
  return (1.f - fv) * (top[0] + fu * (top[1] - top[0])) + fv * (bottom[0] + fu * (bottom[1] - bottom[0]));
}

void Sensor::quantise_row(int y, float brightness, const float* noise, std::uint8_t* grey) const {
  const std::size_t row = static_cast<std::size_t>(y) * width_;
  const bool has_glare = settings_.glare > 0.0;
  for (int x = 0; x < width_; ++x) {
    const float glare = has_glare ? glare_at(x, y) : 0.f;
    const float light = std::clamp((blurred_[row + x] * brightness + glare) * vignette_[row + x], 0.f, 255.f);
    const float value = light + noise[x] * sigma_grey_[static_cast<std::size_t>(static_cast<int>(light))];
    grey[x] = static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.f, 255.f));
  }
}

void Sensor::expose(const std::vector<float>& radiance, const MotionField& motion, const Exposure& exposure,
                    std::uint64_t frame, std::vector<std::uint8_t>& grey) {
  pad(radiance);
  // The kernels are computed here, before several threads read them.
  kernel_of_block_.resize(motion.dx_px.size());
  for (std::size_t i = 0; i < kernel_of_block_.size(); ++i)
    kernel_of_block_[i] = &kernel(motion.dx_px[i], motion.dy_px[i]);
  workers_.parallel_for(motion.blocks_y, kBandBlocks, [&](int begin, int end) {
    for (int by = begin; by < end; ++by)
      for (int bx = 0; bx < motion.blocks_x; ++bx)
        blur_block(bx, by, *kernel_of_block_[static_cast<std::size_t>(by) * motion.blocks_x + bx]);
  });

  double brightness = exposure.light * exposure.gain;
  if (settings_.exposure_ms > 0.0) brightness *= exposure.exposure_ms / settings_.exposure_ms;
  const auto brightness_f = static_cast<float>(brightness);
  if (settings_.glare > 0.0) compute_glare(motion.blocks_x, motion.blocks_y, brightness_f);
  // Gain amplifies the noise with the signal: fewer photons give the same grey level.
  for (int level = 0; level < 256; ++level) {
    const double read = settings_.read_noise_grey * exposure.gain;
    const double shot2 =
        settings_.shot_noise_grey * settings_.shot_noise_grey * exposure.gain * level / 128.0;
    sigma_grey_[static_cast<std::size_t>(level)] = static_cast<float>(std::sqrt(read * read + shot2));
  }
  grey.resize(blurred_.size());
  Random random(derived_seed(seed_, 0x100 + frame));
  std::vector<const float*> noise;
  noise.reserve(static_cast<std::size_t>(height_));
  for (int y = 0; y < height_; ++y) noise.push_back(noise_.data() + (random.next() & (kNoiseSamples - 1)));
  workers_.parallel_for(height_, kBandBlocks * kMotionBlock_px, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      quantise_row(y, brightness_f, noise[static_cast<std::size_t>(y)],
                   grey.data() + static_cast<std::size_t>(y) * width_);
  });
}

}  // namespace heel::sim
