#include "sharpness.h"

#include <opencv2/imgproc.hpp>

namespace heel::cli {

double sharpness_of(const cv::Mat& grey) {
  cv::Mat edges;
  cv::Laplacian(grey, edges, CV_16S);
  cv::Scalar mean, deviation;
  cv::meanStdDev(edges, mean, deviation);
  return deviation[0];
}

}  // namespace heel::cli
