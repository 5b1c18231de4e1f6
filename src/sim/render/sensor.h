// From radiance to 8-bit grey: lens blur, motion blur over the exposure, glare, vignetting, exposure and
// gain, shot and read noise.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/render/exposure.h"
#include "sim/render/ray_table.h"
#include "sim/render/thread_pool.h"

namespace heel::sim {

struct SensorSettings {
  double exposure_ms = 8.0;      ///< shutter time: the length of motion blur
  double gain = 1.0;             ///< grey levels at the output per grey level of radiance
  double blur_sigma_px = 0.45;   ///< lens and pixel aperture, Gaussian
  double vignetting = 0.3;       ///< share of the light lost in the corner of the picture
  double glare = 0.0;            ///< share of the light that lens and dust scatter over the picture
  double read_noise_grey = 1.0;  ///< one standard deviation at gain 1, at any level
  double shot_noise_grey =
      2.0;  ///< one standard deviation at grey 128 and gain 1, growing as the square root
};

/// Image motion during the exposure, one vector for every block of kMotionBlockPx², in pixels.
inline constexpr int kMotionBlock_px = 8;
struct MotionField {
  int blocks_x = 0;
  int blocks_y = 0;
  std::vector<float> dx_px;
  std::vector<float> dy_px;
};

class Sensor {
 public:
  /// `workers` share the rows.
  Sensor(const RayTable& rays, const SensorSettings& settings, std::uint64_t seed, ThreadPool& workers);

  /// `radiance` holds one value a pixel, for the room's light by itself. The noise is a function of the seed
  /// and `frame`, nothing else.
  void expose(const std::vector<float>& radiance, const MotionField& motion, const Exposure& exposure,
              std::uint64_t frame, std::vector<std::uint8_t>& grey);

 private:
  struct Tap {
    std::ptrdiff_t offset;
    float weight;
  };

  void pad(const std::vector<float>& radiance);
  const std::vector<Tap>& kernel(float dx_px, float dy_px);
  void blur_block(int block_x, int block_y, const std::vector<Tap>& taps);
  void scatter(int blocks_x, int blocks_y, float brightness);
  float scattered(int x, int y) const;
  void quantise_row(int y, float brightness, const float* noise, std::uint8_t* grey) const;

  ThreadPool& workers_;
  int width_;
  int height_;
  int padded_stride_;
  SensorSettings settings_;
  std::uint64_t seed_;
  std::vector<float> vignette_;
  std::vector<float> noise_;       ///< standard normal samples, read at a random offset every row
  std::vector<float> sigma_grey_;  ///< noise by grey level, at this frame's gain
  std::vector<float> padded_;
  std::vector<float> blurred_;
  std::vector<std::vector<Tap>> kernels_;          ///< by quantised motion, made when first needed
  std::vector<const std::vector<Tap>*> of_block_;  ///< this frame's
  int glare_columns_ = 0;
  std::vector<float> glare_;  ///< grey levels, one for every block
};

}  // namespace heel::sim
