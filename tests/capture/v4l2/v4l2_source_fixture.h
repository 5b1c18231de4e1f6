// A V4L2 source on a scripted device, and the frames that it is given.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "capture/v4l2/scripted_v4l2_device.h"
#include "capture/v4l2/v4l2_source.h"

namespace heel::test {

inline constexpr std::uint32_t kWidth = 8;
inline constexpr std::uint32_t kHeight = 4;

inline std::uint8_t luma(std::uint32_t x, std::uint32_t y, std::uint32_t sequence) {
  return static_cast<std::uint8_t>(x * 5 + y * 41 + sequence * 3);
}

/// A source on a scripted device whose grey values tell the frame's number.
class V4l2SourceTest : public testing::Test {
 protected:
  V4l2SourceTest() {
    config_.width_px = kWidth;
    config_.height_px = kHeight;
  }

  V4l2Source make() { return {"/dev/scripted", config_, std::make_unique<ScriptedV4l2Device>(camera_)}; }

  void expect_frame(V4l2Source& source, std::uint32_t driver_sequence) {
    ASSERT_EQ(source.wait_frame(0, frame_), FrameResult::Frame) << source.problem();
    ASSERT_EQ(frame_.header.width_px, kWidth);
    ASSERT_EQ(frame_.header.height_px, kHeight);
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        ASSERT_EQ(frame_.grey[y * frame_.stride_bytes + x], luma(x, y, driver_sequence)) << x << ',' << y;
      }
    }
  }

  // A grey frame in the camera's format (two bytes a pixel: YUYV, three: RGB), with the camera's row padding.
  ScriptedFrame made(std::uint32_t sequence, std::uint32_t pixel_bytes) const {
    const std::uint32_t stride = kWidth * pixel_bytes + camera_.padding;
    ScriptedFrame frame{.bytes = std::vector<std::uint8_t>(stride * kHeight, 0xee), .sequence = sequence};
    for (std::uint32_t y = 0; y < kHeight; ++y) {
      for (std::uint32_t x = 0; x < kWidth; ++x) {
        const auto pixel = frame.bytes.begin() + y * stride + x * pixel_bytes;
        std::fill_n(pixel, pixel_bytes == 3 ? 3 : 1, luma(x, y, sequence));
      }
    }
    return frame;
  }
  void give(std::uint32_t sequence, std::uint32_t pixel_bytes = 2) {
    camera_.frames.push_back(made(sequence, pixel_bytes));
  }

  ScriptedCamera camera_;
  CameraConfig config_;
  FrameView frame_;
};

}  // namespace heel::test
