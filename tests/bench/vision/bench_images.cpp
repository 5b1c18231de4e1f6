#include "bench/vision/bench_images.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "support/test_data.h"

namespace heel::evaluation {

cv::Mat textured_image(cv::Size size) {
  cv::Mat grey = cv::imread(test::data_path("oxford/graf/img1.ppm"), cv::IMREAD_GRAYSCALE);
  if (grey.empty()) {
    grey = noise_image(size);
    cv::GaussianBlur(grey, grey, {}, 3.0);
    cv::normalize(grey, grey, 0, 255, cv::NORM_MINMAX);
  }
  cv::Mat resized;
  cv::resize(grey, resized, size, 0, 0, size.width < grey.cols ? cv::INTER_AREA : cv::INTER_CUBIC);
  return resized;
}

cv::Mat noise_image(cv::Size size) {
  cv::Mat grey(size, CV_8U);
  cv::RNG random(7);
  random.fill(grey, cv::RNG::UNIFORM, 0, 256);
  return grey;
}

cv::Mat checkerboard_image(int period_px, cv::Size size) {
  cv::Mat grey(size, CV_8U);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x)
      grey.at<std::uint8_t>(y, x) = (x / period_px + y / period_px) % 2 != 0 ? 255 : 0;
  }
  return grey;
}

FrameView view_of(const cv::Mat& grey) {
  FrameView frame;
  frame.header.width_px = static_cast<std::uint32_t>(grey.cols);
  frame.header.height_px = static_cast<std::uint32_t>(grey.rows);
  frame.grey = grey.data;
  frame.stride_bytes = static_cast<std::uint32_t>(grey.step[0]);
  return frame;
}

}  // namespace heel::evaluation
