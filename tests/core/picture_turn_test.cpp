// Turned and mirrored pictures, on a picture whose every pixel is another.
#include "core/picture_turn.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace heel {
namespace {

constexpr std::uint32_t kWidth_px = 3, kHeight_px = 2;
// 1 2 3
// 4 5 6
const std::vector<std::uint8_t> kPicture{1, 2, 3, 4, 5, 6};

std::vector<std::uint8_t> turned(const PictureTurn& turn) {
  std::vector<std::uint8_t> out(kPicture.size());
  turn_grey(turn, kPicture.data(), kWidth_px, kWidth_px, kHeight_px, out.data());
  return out;
}

using Pixels = std::vector<std::uint8_t>;

TEST(PictureTurn, TurnsClockwise) {
  EXPECT_EQ(turned({}), kPicture);
  EXPECT_EQ(turned(picture_turn(90, false)), (Pixels{4, 1, 5, 2, 6, 3}));
  EXPECT_EQ(turned(picture_turn(180, false)), (Pixels{6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(turned(picture_turn(270, false)), (Pixels{3, 6, 2, 5, 1, 4}));
}

TEST(PictureTurn, MirrorsLeftToRightBeforeItTurns) {
  EXPECT_EQ(turned(picture_turn(0, true)), (Pixels{3, 2, 1, 6, 5, 4}));
  EXPECT_EQ(turned(picture_turn(90, true)), (Pixels{6, 3, 5, 2, 4, 1}));
}

TEST(PictureTurn, TheInverseUndoesEachTurnOfALargePictureWithGapsBetweenRows) {
  constexpr std::uint32_t kWide_px = 71, kHigh_px = 37, kStride = 80;
  std::vector<std::uint8_t> picture(kStride * kHigh_px);
  std::iota(picture.begin(), picture.end(), std::uint8_t{0});
  for (const bool mirror : {false, true}) {
    for (const int degrees : {0, 90, 180, 270}) {
      const PictureTurn turn = picture_turn(degrees, mirror);
      PictureTurner there(turn), back(turn.inverse());
      FrameView frame{{7, 8, kWide_px, kHigh_px}, picture.data(), kStride};
      const FrameView first = there.of(frame);
      EXPECT_EQ(first.header.width_px, turn.swaps_sides() ? kHigh_px : kWide_px);
      const FrameView again = back.of(first);
      EXPECT_EQ(again.header.sequence, 7U);
      ASSERT_EQ(again.header.width_px, kWide_px);
      ASSERT_EQ(again.header.height_px, kHigh_px);
      for (std::uint32_t y = 0; y < kHigh_px; ++y)
        for (std::uint32_t x = 0; x < kWide_px; ++x)
          ASSERT_EQ(again.grey[y * again.stride_bytes + x], picture[y * kStride + x])
              << degrees << ' ' << mirror << ' ' << x << ' ' << y;
    }
  }
}

}  // namespace
}  // namespace heel
