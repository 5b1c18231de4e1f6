// The sharpest of many frames.
#pragma once

#include <opencv2/core/mat.hpp>

#include "heel/flow.h"
#include "sharpness.h"

namespace heel::cli {

/// The frame's pixels where they are.
inline cv::Mat grey_of(const FrameView& frame) {
  return {static_cast<int>(frame.header.height_px), static_cast<int>(frame.header.width_px), CV_8UC1,
          const_cast<std::uint8_t*>(frame.grey), frame.stride_bytes};
}

class SharpestPicture {
 public:
  void add(const FrameView& frame) {
    const cv::Mat grey = grey_of(frame);
    const double sharpness = sharpness_of(grey);
    if (sharpness <= sharpness_ && !grey_.empty()) return;
    sharpness_ = sharpness;
    grey_ = grey.clone();
  }
  /// Empty before the first.
  const cv::Mat& grey() const { return grey_; }

 private:
  cv::Mat grey_;
  double sharpness_ = 0.0;
};

}  // namespace heel::cli
