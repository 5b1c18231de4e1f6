// The sensor's noise and blur against their settings.
#include "heel-sim/camera/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "heel-sim/world/scenario.h"

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
  Sensor sensor(RayTable(default_camera_model()), settings, 5);
  std::vector<std::uint8_t> grey;
  for (const double level : {32.0, 128.0, 200.0}) {
    sensor.expose(std::vector<float>(640 * 480, static_cast<float>(level)), uniform_motion(0, 0), 1, grey);
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
  Sensor sensor(RayTable(default_camera_model()), settings, 5);
  std::vector<float> radiance(640 * 480, 0.f);
  radiance[240 * 640 + 320] = 1000.f;
  std::vector<std::uint8_t> grey;
  sensor.expose(radiance, uniform_motion(6.f, 0.f), 1, grey);
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
  Sensor sensor(RayTable(default_camera_model()), settings, 5);
  std::vector<std::uint8_t> grey;
  sensor.expose(std::vector<float>(640 * 480, 200.f), uniform_motion(0, 0), 1, grey);
  EXPECT_NEAR(grey[240 * 640 + 320], 200, 1);
  EXPECT_NEAR(grey[0], 120, 1);
  EXPECT_NEAR(grey[640 * 480 - 1], 120, 1);
}

}  // namespace
}  // namespace heel::sim
