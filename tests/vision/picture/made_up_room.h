// A made-up room, and a camera with noise whose pictures the monitor sees.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "vision/picture/picture_monitor.h"

namespace heel::test {

constexpr int kWidth = 320, kHeight = 240;  // pixels
constexpr double kRate_hz = 30.0;

/// Grey values of a place and a picture; 0…255 and beyond.
using Light = std::function<double(double x, double y, int picture)>;

/// A room: rectangles of different brightness on a wall, which moves to the left as a robot turns.
class Room {
 public:
  explicit Room(unsigned seed, double speed_px = 2.0) : speed_px_(speed_px) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> x(0.0, 2.0 * kWidth), y(0.0, kHeight), size(10.0, 80.0),
        grey(30.0, 220.0);
    for (int i = 0; i < 160; ++i) {
      const double left = x(random), top = y(random);
      boxes_.push_back({left, top, left + size(random), top + size(random), grey(random)});
    }
    picture_.resize(std::size_t{2 * kWidth} * kHeight, 120.0F);
    for (const Box& box : boxes_)
      for (int row = static_cast<int>(box.top); row < std::min<double>(box.bottom, kHeight); ++row)
        for (int column = static_cast<int>(box.left); column < std::min<double>(box.right, 2 * kWidth);
             ++column)
          picture_[index(column, row)] = static_cast<float>(box.grey);
  }

  double grey(double x, double y, int picture) const {
    const int column = static_cast<int>(x + speed_px_ * picture) % (2 * kWidth);
    return picture_[index(column, static_cast<int>(y))];
  }
  Light light() const {
    return [this](double x, double y, int picture) { return grey(x, y, picture); };
  }

  /// The same through a lens that blurs as a box of 2 `radius_px` + 1 pixels.
  void blur(int radius_px) {
    for (int pass = 0; pass < 2; ++pass) {
      blur_along(radius_px, 1, 2 * kWidth, kHeight, 2 * kWidth);
      blur_along(radius_px, 2 * kWidth, kHeight, 2 * kWidth, 1);
    }
  }

 private:
  struct Box {
    double left, top, right, bottom, grey;
  };
  static std::size_t index(int column, int row) {
    return static_cast<std::size_t>(row) * 2 * kWidth + static_cast<std::size_t>(column);
  }
  void blur_along(int radius, int step, int length, int lines, int line_step) {
    std::vector<float> line(static_cast<std::size_t>(length));
    for (int l = 0; l < lines; ++l) {
      float* first = picture_.data() + static_cast<std::ptrdiff_t>(l) * line_step;
      for (int i = 0; i < length; ++i) {
        float sum = 0.0F;
        for (int k = -radius; k <= radius; ++k)
          sum += first[static_cast<std::ptrdiff_t>(std::clamp(i + k, 0, length - 1)) * step];
        line[static_cast<std::size_t>(i)] = sum / static_cast<float>(2 * radius + 1);
      }
      for (int i = 0; i < length; ++i)
        first[static_cast<std::ptrdiff_t>(i) * step] = line[static_cast<std::size_t>(i)];
    }
  }

  double speed_px_;
  std::vector<Box> boxes_;
  std::vector<float> picture_;
};

/// A camera with noise, and the monitor that sees its pictures.
class Camera {
 public:
  explicit Camera(double noise = 2.0) : noise_(noise) {}

  /// The fault after each of `pictures` pictures.
  std::vector<PictureFault> see(const Light& light, int pictures) {
    std::vector<PictureFault> faults;
    for (int i = 0; i < pictures; ++i, ++picture_) {
      for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
          grey_[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)] =
              static_cast<std::uint8_t>(std::clamp(light(x, y, picture_) + noise_ * noise(), 0.0, 255.0));
      faults.push_back(monitor_.update(view()));
    }
    return faults;
  }
  PictureFault after(const Light& light, double seconds) {
    return see(light, static_cast<int>(seconds * kRate_hz)).back();
  }

 private:
  FrameView view() const {
    FrameView frame;
    frame.header.width_px = kWidth;
    frame.header.height_px = kHeight;
    frame.header.t_capture_ns = kNsPerS + static_cast<TimeNs>(picture_ * 1e9 / kRate_hz);
    frame.grey = grey_.data();
    frame.stride_bytes = kWidth;
    return frame;
  }
  /// About normal, and fast.
  double noise() {
    const auto bits = static_cast<std::uint32_t>(random_());
    return (static_cast<double>(bits & 0xff) + (bits >> 8 & 0xff) + (bits >> 16 & 0xff) + (bits >> 24) -
            510.0) /
           148.0;
  }

  double noise_;
  std::mt19937 random_{7};
  PictureMonitor monitor_;
  std::vector<std::uint8_t> grey_ = std::vector<std::uint8_t>(std::size_t{kWidth} * kHeight);
  int picture_ = 0;
};

inline Light times(const Light& light, const std::function<double(double y, int picture)>& factor) {
  return [=](double x, double y, int picture) { return light(x, y, picture) * factor(y, picture); };
}

}  // namespace heel::test
