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

}  // namespace
}  // namespace heel
