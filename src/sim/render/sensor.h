// The image sensor, from radiance to 8-bit grey: lens blur, motion blur during the exposure, glare,
// vignetting, exposure and gain, shot and read noise.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/render/exposure.h"
#include "sim/render/ray_table.h"
#include "sim/render/thread_pool.h"

namespace heel::sim {

struct SensorSettings {
  double exposure_ms = 8.0;      ///< shutter time; motion blur is proportional to it
  double gain = 1.0;             ///< output grey levels per grey level of radiance
  double blur_sigma_px = 0.45;   ///< of lens and pixel aperture, Gaussian
  double vignetting = 0.3;       ///< share of the light lost in the corners of the picture
  double glare = 0.0;            ///< share of the light that lens and dust scatter over the picture
  double read_noise_grey = 1.0;  ///< standard deviation at gain 1, the same at every grey level
  double shot_noise_grey =
      2.0;  ///< standard deviation at grey 128 and gain 1; grows with the root of the level
};

/// Image motion during the exposure: one vector for every block of kMotionBlock_px × kMotionBlock_px pixels.
inline constexpr int kMotionBlock_px = 8;
struct MotionField {
  int blocks_x = 0;
  int blocks_y = 0;
  std::vector<float> dx_px;
  std::vector<float> dy_px;
};

class Sensor {
 public:
  /// `workers` process the rows in parallel.
  Sensor(const RayTable& rays, const SensorSettings& settings, std::uint64_t seed, ThreadPool& workers);

  /// `radiance` has one value for each pixel, at the room's normal light. The noise depends on the seed and
  /// `frame` only.
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
  void compute_glare(int blocks_x, int blocks_y, float brightness);
  float glare_at(int x, int y) const;
  void quantise_row(int y, float brightness, const float* noise, std::uint8_t* grey) const;

  ThreadPool& workers_;
  int width_;
  int height_;
  int padded_stride_;
  SensorSettings settings_;
  std::uint64_t seed_;
  std::vector<float> vignette_;
  std::vector<float> noise_;       ///< standard normal samples; each row reads them from a random offset
  std::vector<float> sigma_grey_;  ///< standard deviation of the noise by grey level, at this frame's gain
  std::vector<float> padded_;
  std::vector<float> blurred_;
  std::vector<std::vector<Tap>> kernels_;                 ///< by quantised motion, computed when first needed
  std::vector<const std::vector<Tap>*> kernel_of_block_;  ///< in this frame
  int glare_columns_ = 0;
  std::vector<float> glare_;  ///< grey levels to add, one for each block
};

}  // namespace heel::sim
