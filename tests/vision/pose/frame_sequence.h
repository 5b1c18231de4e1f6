// Frames of a sequence, and two frames put together.
#pragma once

#include <opencv2/core.hpp>

#include "heel/flow.h"
#include "vision/pose/rendered_shirt.h"

namespace heel::test {

inline constexpr TimeNs kFramePeriod_ns = kNsPerS / 30;

inline FrameView frame_at(const cv::Mat& image, int number) {
  FrameView view = view_of(image);
  view.header.t_capture_ns = number * kFramePeriod_ns;
  return view;
}

/// The left half of one frame and the right half of the other.
inline cv::Mat side_by_side(const cv::Mat& left, const cv::Mat& right) {
  cv::Mat both = left.clone();
  const cv::Rect half(left.cols / 2, 0, left.cols - left.cols / 2, left.rows);
  right(half).copyTo(both(half));
  return both;
}

}  // namespace heel::test
