// The sensor's noise and blur against their settings.
#include "sim/render/sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "sim/scene/scenario.h"

namespace heel::sim {
namespace {

MotionField uniform_motion(float dx_px, float dy_px) {
  MotionField motion;
  motion.blocks_x = 80;
  motion.blocks_y = 60;
  motion.dx_px.assign(4800, dx_px);
  motion.dy_px.assign(4800, dy_px);
  return motion;
}

TEST(Sensor, NoiseHasTheStatedStrength) {
  SensorSettings settings;
  settings.vignetting = 0;
  settings.read_noise_grey = 1.5;
  settings.shot_noise_grey = 3.0;
  ThreadPool workers(2);
  Sensor sensor(RayTable(default_camera_model()), settings, 5, workers);
  std::vector<std::uint8_t> grey;
  for (const double level : {32.0, 128.0, 200.0}) {
    sensor.expose(std::vector<float>(640 * 480, static_cast<float>(level)), uniform_motion(0, 0), Exposure{},
                  1, grey);
    double sum = 0, squares = 0;
    for (const std::uint8_t pixel : grey) {
      sum += pixel;
      squares += static_cast<double>(pixel) * pixel;
    }
    const double mean = sum / 307200;
    const double sigma = std::sqrt(squares / 307200 - mean * mean);
    EXPECT_NEAR(mean, level, 0.1);
    EXPECT_NEAR(sigma, std::sqrt(1.5 * 1.5 + 9.0 * level / 128 + 1.0 / 12), 0.05) << level;
  }
}

TEST(Sensor, BlurSpreadsAPointAlongTheMotionAndKeepsItsLight) {
  SensorSettings settings;
  settings.vignetting = 0;
  settings.read_noise_grey = 0;
  settings.shot_noise_grey = 0;
  ThreadPool workers(2);
  Sensor sensor(RayTable(default_camera_model()), settings, 5, workers);
  std::vector<float> radiance(640 * 480, 0.f);
  radiance[240 * 640 + 320] = 1000.f;
  std::vector<std::uint8_t> grey;
  sensor.expose(radiance, uniform_motion(6.f, 0.f), Exposure{}, 1, grey);
  double sum = 0, x_mean = 0, x2 = 0, y2 = 0;
  for (int y = 230; y < 251; ++y)
    for (int x = 305; x < 336; ++x) {
      const double g = grey[static_cast<std::size_t>(y) * 640 + x];
      sum += g;
      x_mean += g * (x - 320);
      x2 += g * (x - 320) * (x - 320);
      y2 += g * (y - 240) * (y - 240);
    }
  EXPECT_NEAR(sum, 1000, 25);  // rounded to whole levels
  EXPECT_NEAR(x_mean / sum, 0, 0.05);
  EXPECT_NEAR(std::sqrt(x2 / sum), std::sqrt(6.0 * 6.0 / 12 + 0.45 * 0.45), 0.25);
  EXPECT_LT(std::sqrt(y2 / sum), 0.55);
}

TEST(Sensor, CornersAreDarkerByTheVignetting) {
  SensorSettings settings;
  settings.vignetting = 0.4;
  settings.read_noise_grey = 0;
  settings.shot_noise_grey = 0;
  ThreadPool workers(2);
  Sensor sensor(RayTable(default_camera_model()), settings, 5, workers);
  std::vector<std::uint8_t> grey;
  sensor.expose(std::vector<float>(640 * 480, 200.f), uniform_motion(0, 0), Exposure{}, 1, grey);
  EXPECT_NEAR(grey[240 * 640 + 320], 200, 1);
  EXPECT_NEAR(grey[0], 120, 1);
  EXPECT_NEAR(grey[640 * 480 - 1], 120, 1);
}

/// Mean and deviation of an evenly lit picture.
std::pair<double, double> evenly_lit(const SensorSettings& settings, float radiance,
                                     const Exposure& exposure) {
  ThreadPool workers(2);
  Sensor sensor(RayTable(default_camera_model()), settings, 5, workers);
  std::vector<std::uint8_t> grey;
  sensor.expose(std::vector<float>(640 * 480, radiance), uniform_motion(0, 0), exposure, 1, grey);
  double sum = 0, squares = 0;
  for (const std::uint8_t pixel : grey) {
    sum += pixel;
    squares += static_cast<double>(pixel) * pixel;
  }
  const double mean = sum / 307200;
  return {mean, std::sqrt(squares / 307200 - mean * mean)};
}

TEST(Sensor, GainBringsLightAndNoise) {
  SensorSettings settings;
  settings.vignetting = 0;
  const auto [bright, quiet] = evenly_lit(settings, 128.f, Exposure{});
  // A quarter of the light, half made up by the shutter, half by gain: as bright, and noisier as √2 predicts
  // for the shot noise, 2 for the read noise.
  const auto [gained, noisy] = evenly_lit(settings, 128.f, {.light = 0.25, .exposure_ms = 16.0, .gain = 2.0});
  EXPECT_NEAR(bright, gained, 0.2);
  EXPECT_NEAR(quiet, std::sqrt(1.0 + 4.0 + 1.0 / 12), 0.05);
  EXPECT_NEAR(noisy, std::sqrt(4.0 + 2 * 4.0 + 1.0 / 12), 0.05);
  EXPECT_NEAR(evenly_lit(settings, 128.f, {.light = 0.5, .exposure_ms = 8.0, .gain = 1.0}).first, 64, 0.2);
}

TEST(Sensor, GlareSpreadsFromWhatIsBright) {
  SensorSettings settings;
  settings.vignetting = 0;
  settings.read_noise_grey = 0;
  settings.shot_noise_grey = 0;
  settings.glare = 0.2;
  ThreadPool workers(2);
  Sensor sensor(RayTable(default_camera_model()), settings, 5, workers);
  std::vector<float> radiance(640 * 480, 20.f);
  for (int y = 200; y < 280; ++y)
    for (int x = 280; x < 360; ++x) radiance[static_cast<std::size_t>(y) * 640 + x] = 1500.f;
  std::vector<std::uint8_t> grey;
  sensor.expose(radiance, uniform_motion(0, 0), Exposure{}, 1, grey);
  const auto at = [&](int x, int y) { return static_cast<int>(grey[static_cast<std::size_t>(y) * 640 + x]); };
  EXPECT_EQ(at(320, 240), 255);
  EXPECT_GT(at(370, 240), at(420, 240) + 5);
  EXPECT_GT(at(420, 240), at(560, 240) + 5);
  EXPECT_GE(at(620, 20), 20);
  EXPECT_LT(at(20, 20), 40);
  EXPECT_NEAR(at(370, 240), at(269, 240), 12);  // to all sides alike
  EXPECT_NEAR(at(320, 290), at(370, 240), 12);
}

}  // namespace
}  // namespace heel::sim
