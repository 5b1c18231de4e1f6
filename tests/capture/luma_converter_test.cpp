// Frames of a wrong length are refused before they are read.
#include "capture/luma_converter.h"

#include <gtest/gtest.h>

#include <vector>

namespace heel {
namespace {

TEST(LumaConverter, RefusesFramesThatAreEmptyTooShortOrLongerThanTheirBuffer) {
  LumaConverter converter;
  converter.configure(PixelFormat::Grey, 4, 2, 4);
  const std::vector<std::uint8_t> buffer(9);
  FrameView frame;
  for (const std::size_t used_bytes : {0u, 7u, 10u}) {
    EXPECT_FALSE(converter.convert(buffer.data(), used_bytes, buffer.size(), frame)) << used_bytes;
    EXPECT_STREQ(converter.problem(), "the frame is too short") << used_bytes;
  }
  EXPECT_TRUE(converter.convert(buffer.data(), 8, buffer.size(), frame));
  EXPECT_EQ(frame.grey, buffer.data());
}

TEST(LumaConverter, OfInterlacedFramesEverySecondRowIsUsed) {
  // Luma of rows 0 to 3; rows 1 and 3 are of another time.
  const std::vector<std::uint8_t> grey = {10, 20, 90, 90, 30, 51, 200, 200};
  const std::vector<std::uint8_t> yuyv = {10, 128, 20, 128, 90,  128, 90,  128,
                                          30, 128, 51, 128, 200, 128, 200, 128};
  const std::vector<std::uint8_t> expected = {10, 20, 20, 36, 30, 51, 30, 51};
  LumaConverter converter;
  FrameView frame;
  converter.configure(PixelFormat::Grey, 2, 4, 2, true);
  ASSERT_TRUE(converter.convert(grey.data(), grey.size(), grey.size(), frame));
  EXPECT_EQ(std::vector<std::uint8_t>(frame.grey, frame.grey + 8), expected);
  converter.configure(PixelFormat::Yuyv, 2, 4, 4, true);
  ASSERT_TRUE(converter.convert(yuyv.data(), yuyv.size(), yuyv.size(), frame));
  EXPECT_EQ(std::vector<std::uint8_t>(frame.grey, frame.grey + 8), expected);
  EXPECT_EQ(frame.stride_bytes, 2u);
}

}  // namespace
}  // namespace heel
