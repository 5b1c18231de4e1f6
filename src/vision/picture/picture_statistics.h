// What one picture shows of its own quality, measured on a sample of its pixels: about a tenth of them.
// Nothing of it depends on whose shirt is sought.
//
// Units: grey values 0…255; widths in pixels of a picture 640 pixels wide.
#pragma once

#include <array>
#include <cstddef>

#include "heel/flow.h"

namespace heel {

struct PictureBrightness {
  /// Bands of rows; the mean brightness of each is kept for the left and the right half of the picture.
  static constexpr std::size_t kBands = 96;

  double mean = 0.0;
  double darkest = 0.0;  ///< 2 % of the pixels are darker
  std::array<std::array<float, kBands>, 2> bands{};
};

struct PictureEdges {
  double detail = 0.0;  ///< share of the places where the brightness changes within a few pixels
  /// Standard deviation of the Gaussian blur of the sharpest tenth of the edges, in the direction in which
  /// they are sharper; 0: too few edges to say.
  double edge_blur_px = 0.0;
  double comb = 0.0;  ///< share of the upright edges at which every second row is displaced
};

// Of a picture of at least 64 x 64 pixels; smaller ones give zeros. They allocate nothing.
PictureBrightness picture_brightness(const FrameView& frame);
PictureEdges picture_edges(const FrameView& frame);

}  // namespace heel
