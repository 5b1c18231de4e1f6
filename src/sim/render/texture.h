// Grey textures with mip-maps. Coordinate (0, 0) is the centre of the first texel; both axes wrap around.
#pragma once

#include <cstdint>
#include <vector>

namespace heel::sim {

/// An image to draw on: reflectance in grey levels, 0 black … 255 white.
class Canvas {
 public:
  /// The sides must be powers of two, because wrapping is done with a bit mask.
  Canvas(int width, int height, float grey);

  int width() const { return width_; }
  int height() const { return height_; }
  float& at(int x, int y) { return grey_[static_cast<std::size_t>(y) * width_ + x]; }
  float at(int x, int y) const { return grey_[static_cast<std::size_t>(y) * width_ + x]; }

  /// Blends `grey` over the texel with the given coverage (0…1). Does nothing outside the canvas.
  void blend(int x, int y, float grey, float coverage);

 private:
  int width_;
  int height_;
  std::vector<float> grey_;
};

class Texture {
 public:
  struct Level {
    int width_mask = 0;
    int height_mask = 0;
    int width_shift = 0;
    std::vector<std::uint8_t> texels;
  };

  explicit Texture(const Canvas& canvas);

  int levels() const { return static_cast<int>(levels_.size()); }
  const Level& level(int index) const { return levels_[static_cast<std::size_t>(index)]; }

 private:
  std::vector<Level> levels_;
};

}  // namespace heel::sim
