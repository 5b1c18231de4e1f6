// From radiance to 8-bit grey: lens blur, motion blur over the exposure, vignetting, shot and read noise.
#pragma once

#include <cstdint>
#include <vector>

#include "heel-sim/camera/ray_table.h"

namespace heel::sim {

struct SensorSettings {
  double exposure_ms = 8.0;      ///< shutter time: the length of motion blur
  double gain = 1.0;             ///< grey levels at the output per grey level of radiance
  double blur_sigma_px = 0.45;   ///< lens and pixel aperture, Gaussian
  double vignetting = 0.3;       ///< share of the light lost in the corner of the picture
  double read_noise_grey = 1.0;  ///< one standard deviation, at any level
  double shot_noise_grey = 2.0;  ///< one standard deviation at grey 128, growing as the square root
};

/// Image motion during the exposure, one vector for every block of kMotionBlockPx², in pixels.
inline constexpr int kMotionBlockPx = 8;
struct MotionField {
  int blocks_x = 0;
  int blocks_y = 0;
  std::vector<float> dx_px;
  std::vector<float> dy_px;
};

class Sensor {
 public:
  Sensor(const RayTable& rays, const SensorSettings& settings, std::uint64_t seed);

  /// `radiance` holds one value a pixel. The noise is a function of the seed and `frame`, nothing else.
  void expose(const std::vector<float>& radiance, const MotionField& motion, std::uint64_t frame,
              std::vector<std::uint8_t>& grey);

 private:
  struct Tap {
    std::ptrdiff_t offset;
    float weight;
  };

  void pad(const std::vector<float>& radiance);
  const std::vector<Tap>& kernel(float dx_px, float dy_px);
  void blur_block(int block_x, int block_y, const std::vector<Tap>& taps);
  void quantise(std::uint64_t frame, std::vector<std::uint8_t>& grey) const;

  int width_;
  int height_;
  int padded_stride_;
  SensorSettings settings_;
  std::uint64_t seed_;
  std::vector<float> vignette_;
  std::vector<float> noise_;       ///< standard normal samples, read at a random offset every row
  std::vector<float> sigma_grey_;  ///< noise by grey level
  std::vector<float> padded_;
  std::vector<float> blurred_;
  std::vector<std::vector<Tap>> kernels_;  ///< by quantised motion, made when first needed
};

}  // namespace heel::sim
