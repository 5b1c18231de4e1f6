// The Oxford sets' image pairs with their true homographies (K. Mikolajczyk et al., "A comparison of affine
// region detectors", IJCV 2005), read from the test data.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "heel/flow.h"
#include "support/test_data.h"

namespace heel::test {

struct OxfordPair {
  std::string set;  ///< graf, boat, leuven
  int to = 2;       ///< image 1 is the reference, this the other
  cv::Mat reference, current;
  Eigen::Matrix3d H_cur_from_ref;

  std::string name() const { return set + " 1-" + std::to_string(to); }
};

/// Of the test data.
inline std::string oxford_folder(const std::string& set) {
  return "oxford/" + set;
}

/// Throws std::runtime_error naming what cannot be read.
inline OxfordPair load_oxford_pair(const std::string& set, int to) {
  const std::filesystem::path folder = data_path(oxford_folder(set));
  const auto image = [&](int number) {
    const std::string path = folder / ("img" + std::to_string(number) + (set == "boat" ? ".pgm" : ".ppm"));
    const cv::Mat grey = cv::imread(path, cv::IMREAD_GRAYSCALE);
    if (grey.empty()) throw std::runtime_error("cannot read " + path);
    return grey;
  };
  OxfordPair pair{set, to, image(1), image(to), {}};
  std::ifstream file(folder / ("H1to" + std::to_string(to) + "p"));
  for (int i = 0; i < 9; ++i) file >> pair.H_cur_from_ref(i / 3, i % 3);
  if (!file) throw std::runtime_error("no homography for " + pair.name() + " in " + folder.string());
  return pair;
}

/// How far apart two homographies map the reference image's corners, on average.
inline double mean_corner_error_px(const OxfordPair& pair, const Eigen::Matrix3d& H_cur_from_ref) {
  const double right = pair.reference.cols - 1, bottom = pair.reference.rows - 1;
  double sum_px = 0.0;
  for (const Eigen::Vector2d& corner : {Eigen::Vector2d(0, 0), Eigen::Vector2d(right, 0),
                                        Eigen::Vector2d(right, bottom), Eigen::Vector2d(0, bottom)}) {
    sum_px += ((H_cur_from_ref * corner.homogeneous()).hnormalized() -
               (pair.H_cur_from_ref * corner.homogeneous()).hnormalized())
                  .norm();
  }
  return sum_px / 4.0;
}

inline FrameView view_of(const cv::Mat& grey) {
  FrameView view;
  view.header.width_px = static_cast<std::uint32_t>(grey.cols);
  view.header.height_px = static_cast<std::uint32_t>(grey.rows);
  view.grey = grey.data;
  view.stride_bytes = static_cast<std::uint32_t>(grey.step[0]);
  return view;
}

}  // namespace heel::test
