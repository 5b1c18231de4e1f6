// Luma out of camera formats, with odd strides and short last rows.
#include "capture/pixel_format.h"

#include <gtest/gtest.h>

#include <vector>

namespace heel {
namespace {

TEST(PixelFormat, NamesThereAndBack) {
  for (const PixelFormat format :
       {PixelFormat::Grey, PixelFormat::Nv12, PixelFormat::Yuyv, PixelFormat::Mjpg}) {
    PixelFormat parsed = format == PixelFormat::Grey ? PixelFormat::Mjpg : PixelFormat::Grey;
    ASSERT_TRUE(parse_pixel_format(to_string(format), parsed));
    EXPECT_EQ(parsed, format);
  }
  PixelFormat untouched = PixelFormat::Yuyv;
  EXPECT_FALSE(parse_pixel_format("auto", untouched));
  EXPECT_EQ(untouched, PixelFormat::Yuyv);
}

TEST(PixelFormat, TheLastRowNeedsNoPadding) {
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Grey, 7, 3, 10), 27u);
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Nv12, 8, 2, 8), 16u) << "the chroma is not read";
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Yuyv, 7, 3, 20), 54u);
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Mjpg, 640, 480, 0), 0u);
}

TEST(PixelFormat, YuyvGivesEverySecondByteOfEachRow) {
  for (const std::uint32_t width_px : {1u, 2u, 7u, 64u, 101u}) {
    for (const std::uint32_t padding : {0u, 1u, 13u}) {
      const std::uint32_t height_px = 5;
      const std::uint32_t stride = 2 * width_px + padding;
      // Exactly as long as promised: the address sanitizer sees a byte read beyond.
      std::vector<std::uint8_t> yuyv(luma_bytes_needed(PixelFormat::Yuyv, width_px, height_px, stride), 0xee);
      for (std::uint32_t y = 0; y < height_px; ++y) {
        for (std::uint32_t x = 0; x < width_px; ++x) {
          yuyv[y * stride + 2 * x] = static_cast<std::uint8_t>(x * 7 + y * 31);
        }
      }
      std::vector<std::uint8_t> grey(width_px * height_px);
      grey_from_yuyv(yuyv.data(), stride, width_px, height_px, grey.data());
      for (std::uint32_t y = 0; y < height_px; ++y) {
        for (std::uint32_t x = 0; x < width_px; ++x) {
          ASSERT_EQ(grey[y * width_px + x], static_cast<std::uint8_t>(x * 7 + y * 31))
              << width_px << "+" << padding << " at " << x << ',' << y;
        }
      }
    }
  }
}

}  // namespace
}  // namespace heel
