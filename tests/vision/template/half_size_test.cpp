// The reduction by two against OpenCV's, and odd sizes.
#include "vision/template/half_size.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace heel {
namespace {

TEST(HalfSize, EqualsOpenCvsAreaReductionToTheBitForEvenSizes) {
  for (const cv::Size size : {cv::Size(2, 2), cv::Size(34, 18), cv::Size(322, 6), cv::Size(640, 480)}) {
    cv::Mat image(size, CV_8UC1);
    cv::RNG(11).fill(image, cv::RNG::UNIFORM, 0, 256);
    cv::Mat expected;
    cv::resize(image, expected, {}, 0.5, 0.5, cv::INTER_AREA);

    const HalfSizeImage half = half_size({image.data, image.total()}, image.cols, image.rows);
    ASSERT_EQ(cv::Size(half.width_px, half.height_px), expected.size());
    EXPECT_EQ(half.grey, std::vector<std::uint8_t>(expected.datastart, expected.dataend)) << size;
  }
}

TEST(HalfSize, RoundsHalvesUp) {
  EXPECT_EQ(half_size(std::vector<std::uint8_t>{1, 1, 0, 0}, 2, 2).grey, std::vector<std::uint8_t>{1});
  EXPECT_EQ(half_size(std::vector<std::uint8_t>{255, 255, 255, 255}, 2, 2).grey,
            std::vector<std::uint8_t>{255});
}

TEST(HalfSize, LeavesOutAnOddLastColumnAndRow) {
  const std::vector<std::uint8_t> grey = {1, 1, 9,  //
                                          1, 1, 9,  //
                                          9, 9, 9};
  const HalfSizeImage half = half_size(grey, 3, 3);
  EXPECT_EQ(half.width_px, 1);
  EXPECT_EQ(half.height_px, 1);
  EXPECT_EQ(half.grey, std::vector<std::uint8_t>{1});
}

}  // namespace
}  // namespace heel
