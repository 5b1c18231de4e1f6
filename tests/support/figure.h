// Checks a drawn figure: it exists as PNG and SVG, has the expected size, and is not blank.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "support/temporary_folder.h"

namespace heel::test {

constexpr double kFigureDpi = 150.0, kPointsPerInch = 72.0;

/// Pixels of about this colour, 0xRRGGBB as in tools/plots/style.py.
inline cv::Mat pixels_of(const cv::Mat& picture, unsigned rgb) {
  const cv::Scalar bgr(rgb & 0xff, (rgb >> 8) & 0xff, (rgb >> 16) & 0xff);
  cv::Mat mask;
  cv::inRange(picture, bgr - cv::Scalar::all(12), bgr + cv::Scalar::all(12), mask);
  return mask;
}

inline int count_of(const cv::Mat& picture, unsigned rgb) {
  return cv::countNonZero(pixels_of(picture, rgb));
}

/// Returns the picture, for further checks.
inline cv::Mat expect_picture(const std::string& path, cv::Size size) {
  cv::Mat picture = cv::imread(path);
  EXPECT_EQ(picture.size(), size) << path;
  if (picture.empty()) return picture;
  const auto white = static_cast<double>(count_of(picture, 0xffffff));
  EXPECT_LT(white, 0.985 * static_cast<double>(picture.total())) << path << " is nearly blank";
  cv::Mat grey, mean, deviation;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  cv::meanStdDev(grey, mean, deviation);
  EXPECT_GT(deviation.at<double>(0), 5.0) << path << " has one colour";
  return picture;
}

/// NAME.png has `size` pixels; NAME.svg has the same size on paper, and shapes.
inline cv::Mat expect_figure(const std::string& name, cv::Size size) {
  const std::string svg = read_text(name + ".svg");
  EXPECT_EQ(svg.rfind("<?xml", 0), 0U) << name << ".svg";
  const auto length_pt = [&](const std::string& attribute) {
    const std::size_t at = svg.find(" " + attribute + "=\"", svg.find("<svg"));
    return at == std::string::npos ? 0.0 : std::strtod(svg.c_str() + at + attribute.size() + 3, nullptr);
  };
  EXPECT_NEAR(length_pt("width"), size.width * kPointsPerInch / kFigureDpi, 0.5) << name << ".svg";
  EXPECT_NEAR(length_pt("height"), size.height * kPointsPerInch / kFigureDpi, 0.5) << name << ".svg";
  int shapes = 0;
  for (std::size_t at = svg.find("<path"); at != std::string::npos; at = svg.find("<path", at + 1)) ++shapes;
  EXPECT_GT(shapes, 20) << name << ".svg";
  EXPECT_NE(svg.find("</svg>"), std::string::npos) << name << ".svg";
  return expect_picture(name + ".png", size);
}

}  // namespace heel::test
