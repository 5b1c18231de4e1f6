// Pictures of a camera that is mounted turned or mirrored: how they become upright.
#pragma once

#include <cstdint>
#include <vector>

#include "heel/flow.h"

namespace heel {

/// First mirrored left to right, then turned clockwise.
struct PictureTurn {
  bool mirror = false;
  int quarters = 0;  ///< clockwise, 0…3

  bool any() const { return mirror || quarters != 0; }
  /// Whether width and height change places.
  bool swaps_sides() const { return quarters % 2 == 1; }
  /// Undoes this one.
  PictureTurn inverse() const { return {mirror, mirror ? quarters : (4 - quarters) % 4}; }
};

/// `degrees`: clockwise, a multiple of 90.
constexpr PictureTurn picture_turn(int degrees, bool mirror) {
  return {mirror, degrees / 90};
}

/// Writes the turned picture to `turned`, rows without gaps; it has width_px · height_px pixels. Does not
/// allocate.
void turn_grey(const PictureTurn& turn, const std::uint8_t* grey, std::uint32_t stride_bytes,
               std::uint32_t width_px, std::uint32_t height_px, std::uint8_t* turned);

/// Turns the frames of a camera.
class PictureTurner {
 public:
  explicit PictureTurner(const PictureTurn& turn) : turn_(turn) {}

  /// Allocates what frames of up to this many pixels need.
  void reserve(std::uint32_t width_px, std::uint32_t height_px);
  /// The turned frame, valid until the next call; where there is nothing to turn the frame itself. Allocates
  /// only for a frame with more pixels than were reserved and than any frame before it had.
  FrameView of(const FrameView& frame);
  const PictureTurn& turn() const { return turn_; }

 private:
  PictureTurn turn_;
  std::vector<std::uint8_t> turned_;
};

}  // namespace heel
