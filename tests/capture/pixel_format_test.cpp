// Luma from camera formats, with odd strides and short last rows.
#include "capture/pixel_format.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace heel {
namespace {

TEST(PixelFormat, NamesAreParsedToTheirFormats) {
  std::set<std::string> names;
  for (const PixelFormat format : pixel_formats()) {
    names.insert(to_string(format));
    PixelFormat parsed = format == PixelFormat::Grey ? PixelFormat::Mjpg : PixelFormat::Grey;
    ASSERT_TRUE(parse_pixel_format(to_string(format), parsed));
    EXPECT_EQ(parsed, format);
  }
  EXPECT_EQ(names, (std::set<std::string>{"GREY", "NV12", "YUYV", "RGB3", "BGR3", "MJPG"}));
  PixelFormat untouched = PixelFormat::Yuyv;
  EXPECT_FALSE(parse_pixel_format("auto", untouched));
  EXPECT_EQ(untouched, PixelFormat::Yuyv);
}

TEST(PixelFormat, TheLastRowNeedsNoPadding) {
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Grey, 7, 3, 10), 27u);
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Nv12, 8, 2, 8), 16u) << "the chroma is not read";
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Yuyv, 7, 3, 20), 54u);
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Bgr3, 7, 3, 25), 71u);
  EXPECT_EQ(luma_bytes_needed(PixelFormat::Mjpg, 640, 480, 0), 0u);
}

/// Frames of every width and padding, exactly as long as luma_bytes_needed says: the address sanitizer finds
/// a byte read after the end.
void expect_luma(PixelFormat format, std::vector<std::uint8_t> (*pixel)(std::uint8_t), double tolerance) {
  for (const std::uint32_t width_px : {1u, 2u, 7u, 64u, 101u}) {
    for (const std::uint32_t padding : {0u, 1u, 13u}) {
      const std::uint32_t height_px = 5, stride = row_bytes(format, width_px) + padding;
      std::vector<std::uint8_t> data(luma_bytes_needed(format, width_px, height_px, stride), 0xee);
      const auto value = [](std::uint32_t x, std::uint32_t y) {
        return static_cast<std::uint8_t>(x * 7 + y * 31);
      };
      for (std::uint32_t y = 0; y < height_px; ++y) {
        for (std::uint32_t x = 0; x < width_px; ++x) {
          const std::vector<std::uint8_t> bytes = pixel(value(x, y));
          std::copy(bytes.begin(), bytes.end(), data.begin() + y * stride + x * bytes.size());
        }
      }
      std::vector<std::uint8_t> grey(width_px * height_px);
      const Luma luma = luma_of(format, data.data(), stride, width_px, height_px, grey.data());
      for (std::uint32_t y = 0; y < height_px; ++y) {
        for (std::uint32_t x = 0; x < width_px; ++x) {
          ASSERT_NEAR(luma.data[y * luma.stride_bytes + x], value(x, y), tolerance)
              << to_string(format) << ' ' << width_px << "+" << padding << " at " << x << ',' << y;
        }
      }
    }
  }
}

TEST(PixelFormat, LumaOfEachUncompressedFormat) {
  using Bytes = std::vector<std::uint8_t>;
  expect_luma(
      PixelFormat::Grey, [](std::uint8_t v) { return Bytes{v}; }, 0.0);
  expect_luma(
      PixelFormat::Nv12, [](std::uint8_t v) { return Bytes{v}; }, 0.0);
  expect_luma(
      PixelFormat::Yuyv,
      [](std::uint8_t v) {
        return Bytes{v, 0x99};
      },
      0.0);
  expect_luma(
      PixelFormat::Rgb3,
      [](std::uint8_t v) {
        return Bytes{v, v, v};
      },
      0.0);
  expect_luma(
      PixelFormat::Bgr3,
      [](std::uint8_t v) {
        return Bytes{v, v, v};
      },
      0.0);
}

TEST(PixelFormat, LumaOfColoursIsThatOfBt601) {
  const std::vector<std::uint8_t> colours{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 200, 100, 50};
  std::vector<std::uint8_t> grey(5);
  for (const PixelFormat format : {PixelFormat::Rgb3, PixelFormat::Bgr3}) {
    luma_of(format, colours.data(), 15, 5, 1, grey.data());
    for (std::size_t i = 0; i < grey.size(); ++i) {
      const std::size_t red = format == PixelFormat::Rgb3 ? 0 : 2;
      const double exact =
          0.299 * colours[3 * i + red] + 0.587 * colours[3 * i + 1] + 0.114 * colours[3 * i + 2 - red];
      EXPECT_NEAR(grey[i], exact, 1.0) << to_string(format) << " colour " << i;
    }
  }
}

}  // namespace
}  // namespace heel
