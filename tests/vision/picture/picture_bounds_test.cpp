// Pictures that are near a bound of a fault, and on the good side of it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "vision/picture/made_up_room.h"
#include "vision/picture/picture_monitor.h"

namespace heel {
namespace {

using test::Camera;
using test::kHeight;
using test::kWidth;
using test::Light;
using test::Room;
using test::times;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// The picture seen with a lamp of 100 Hz whose brightness changes by `share`.
Light by_lamp(const Light& light, double share, double right_half_later_rad = 0.0) {
  return [=](double x, double y, int picture) {
    const double t_s = picture / 29.8 + 0.025 * y / kHeight;  // the shutter reads 25 ms long
    const double phase_rad = kTurn_rad * 100.0 * t_s - (x < kWidth / 2 ? 0.0 : right_half_later_rad);
    return light(x, y, picture) * (1.0 + share * std::sin(phase_rad));
  };
}

void expect_none(const Light& light, double seconds, double noise = 2.0) {
  for (const PictureFault fault : Camera(noise).see(light, static_cast<int>(seconds * test::kRate_hz)))
    ASSERT_EQ(fault, PictureFault::None) << to_string(fault);
}

TEST(PictureBounds, LightsInTheNightAreNotDark) {
  expect_none([](double x, double, int) { return static_cast<int>(x) % 20 < 2 ? 90.0 : 3.0; }, 1.5);
}

TEST(PictureBounds, APalePictureOrOneOfSnowIsNotTooBright) {
  const Light pale = [](double x, double y, int) {
    return (static_cast<int>(x) / 12 + static_cast<int>(y) / 12) % 2 == 0 ? 205.0 : 232.0;
  };
  expect_none(pale, 1.0, 0.0);
  const Light snow = [](double x, double, int) { return static_cast<int>(x) % 40 < 3 ? 90.0 : 254.0; };
  expect_none(snow, 1.0);
}

TEST(PictureBounds, WeakBandsAreNoFlicker) {
  const Room room(5, 0.0);
  expect_none(by_lamp(room.light(), 0.01), 1.5, 0.0);
}

TEST(PictureBounds, WavesThatDifferFromLeftToRightAreNoFlicker) {
  const Room room(5, 0.0);
  expect_none(by_lamp(room.light(), 0.1, 0.2 * kTurn_rad), 1.5);
}

TEST(PictureBounds, FewPicturesWithBandsAreNoFlicker) {
  const Room room(5, 0.0);
  const Light lamp = by_lamp(room.light(), 0.1);
  expect_none(
      [&](double x, double y, int picture) {
        return picture >= 10 && picture < 15 ? lamp(x, y, picture) : room.grey(x, y, picture);
      },
      1.5);
}

TEST(PictureBounds, ARobotThatNodsIsNoFlicker) {
  // Shelves as wide as the picture, of many brightnesses, 8 to 23 pixels high.
  const Light shelves = [](double, double y, int picture) {
    const double seen_y = y + 40.0 + 6.0 * std::sin(0.9 * picture);
    int shelf = 0;
    for (double edge = 0.0; edge < seen_y; ++shelf) edge += 8 + shelf * 7 % 16;
    return 40.0 + shelf * 67 % 170;
  };
  expect_none(shelves, 1.5);
}

TEST(PictureBounds, ASmallOrSlowChangeOfExposureIsNoHunting) {
  const Room room(6);
  const auto changes = [&](double share, double period_s) {
    return times(room.light(), [=](double, int picture) {
      return 1.0 + share * std::sin(kTurn_rad * picture / (period_s * test::kRate_hz));
    });
  };
  expect_none(changes(0.03, 1.0), 4.0);
  expect_none(changes(0.35, 2.0), 6.0);
}

TEST(PictureBounds, OneUprightEdgeOfTwoTimesIsNotInterlaced) {
  // A door frame and its upper half: up to 58 of the places that are looked at have an upright edge.
  const Light door = [](double x, double y, int picture) {
    const double seen_x = x + 3.0 * picture + (static_cast<int>(y) % 2 != 0 ? 4.0 : 0.0);
    return static_cast<int>(seen_x) % 640 < 320 ? 60.0 : 200.0;
  };
  expect_none(door, 2.0);
}

TEST(PictureBounds, FewBlurredEdgesAreNotOutOfFocus) {
  // A soft shadow on a wall whose texture is weak: about 30 of the places looked at are on its edge.
  const Light shadow = [](double x, double y, int) {
    if (y < 60.0 || y > 180.0) return static_cast<int>(x) / 16 % 2 == 0 ? 100.0 : 122.0;
    const double strength = std::exp(-(y - 120.0) * (y - 120.0) / 800.0);
    return 110.0 + 100.0 * strength * std::tanh((x - 165.0) / 14.0);
  };
  expect_none(shadow, 4.0, 0.0);
}

TEST(PictureBounds, FewPicturesOfTwoTimesAreNotInterlaced) {
  const Room room(7, 8.0);
  expect_none(
      [&](double x, double y, int picture) {
        const bool torn = picture >= 10 && picture < 13 && static_cast<int>(y) % 2 != 0;
        return room.grey(x + (torn ? 4.0 : 0.0), y, picture);
      },
      1.0);
}

}  // namespace
}  // namespace heel
